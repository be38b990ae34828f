#include "deformers/tet.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "deformers/tet_constraints.h"
#include "deformers/tet_solver.h"
#include "deformers/tet_transfer.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/check.h"
#include "engine/geometry/error.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/skin.h"

namespace sinew {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// What binds points: the boundary faces and, where the shape's points are vertices, these.
struct TetSurface {
  TetFaces faces;
  std::vector<Vec3> vertices;  ///< with vertex_tets; empty where the surface was decimated
  std::vector<Index> vertex_tets;

  SkinWeights bind(std::span<const Vec3> points, Gradients gradients, std::size_t* widened = nullptr,
                   const std::function<bool(double)>& progress = {}) const {
    if (vertices.empty()) return transfer_weights(faces, points, gradients, widened, progress);
    const auto less = [](const Vec3& a, const Vec3& b) {
      return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
    };
    std::map<Vec3, Index, decltype(less)> at(less);
    for (std::size_t v = 0; v < vertices.size(); ++v) at.emplace(vertices[v], vertex_tets[v]);
    std::vector<Vec3> others;
    std::vector<Index> tet_of(points.size(), TetBinding::none);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto found = points[i].allFinite() ? at.find(points[i]) : at.end();
      if (found != at.end())
        tet_of[i] = found->second;
      else
        others.push_back(points[i]);
    }
    const SkinWeights rest =
        others.empty() ? SkinWeights{} : transfer_weights(faces, others, gradients, widened, progress);
    SkinWeights out;
    if (rest.size() != others.size()) return out;
    for (std::size_t i = 0, k = 0; i < points.size(); ++i) {
      if (tet_of[i] != TetBinding::none) {
        out.maps.push_back(tet_of[i]);
        out.weights.push_back(1);
        if (gradients == Gradients::Yes) out.gradients.push_back(Eigen::Vector3f::Zero());
      } else {
        for (std::uint64_t e = rest.offsets[k]; e < rest.offsets[k + 1]; ++e) {
          out.maps.push_back(rest.maps[e]);
          out.weights.push_back(rest.weights[e]);
          if (gradients == Gradients::Yes) out.gradients.push_back(rest.gradients[e]);
        }
        ++k;
      }
      out.offsets.push_back(out.maps.size());
    }
    return out;
  }

  std::vector<Deformer::Table> tables() const {
    std::vector<Deformer::Table> out{{"centres", 3, {}}, {"tets", 1, {}}, {"radius", 1, {faces.radius}}};
    const auto add = [](Deformer::Table& table, const Vec3& p) {
      table.values.insert(table.values.end(), p.data(), p.data() + 3);
    };
    for (const Vec3& p : faces.centres) add(out[0], p);
    for (const Index t : faces.tets) out[1].values.push_back(t);
    if (vertices.empty()) return out;
    out.push_back({"vertices", 3, {}});
    for (const Vec3& p : vertices) add(out.back(), p);
    out.push_back({"vertex_tets", 1, {}});
    for (const Index t : vertex_tets) out.back().values.push_back(t);
    return out;
  }

  static TetSurface from_tables(const std::vector<Deformer::Table>& tables) {
    const auto find = [&](const char* name, int columns, bool needed) -> const std::vector<double>& {
      static const std::vector<double> none;
      for (const Deformer::Table& table : tables)
        if (table.name == name && table.columns == columns) return table.values;
      if (needed) throw InputError("expected a table \"" + std::string(name) + "\" of the tets' binding, found none");
      return none;
    };
    const auto points = [](const std::vector<double>& values) {
      std::vector<Vec3> out;
      for (std::size_t i = 0; i + 2 < values.size(); i += 3) out.emplace_back(values[i], values[i + 1], values[i + 2]);
      return out;
    };
    const auto indices = [](const std::vector<double>& values, const char* name) {
      std::vector<Index> out;
      for (const double v : values) {
        if (!(v >= 0 && v < 4294967295.0 && v == std::floor(v)))
          throw InputError("expected numbers of tets in \"" + std::string(name) + "\", found " + std::to_string(v));
        out.push_back(static_cast<Index>(v));
      }
      return out;
    };
    TetSurface out;
    out.faces.centres = points(find("centres", 3, true));
    out.faces.tets = indices(find("tets", 1, true), "tets");
    const std::vector<double>& radius = find("radius", 1, true);
    out.vertices = points(find("vertices", 3, false));
    out.vertex_tets = indices(find("vertex_tets", 1, false), "vertex_tets");
    if (out.faces.centres.empty() || out.faces.tets.size() != out.faces.centres.size())
      throw InputError("expected a tet for each of the centres, at least one, found " +
                       std::to_string(out.faces.tets.size()) + " for " + std::to_string(out.faces.centres.size()));
    if (radius.size() != 1 || !(radius[0] > 0)) throw InputError("expected one radius above 0, found another");
    if (out.vertices.size() != out.vertex_tets.size())
      throw InputError("expected a tet for each vertex, found " + std::to_string(out.vertex_tets.size()) + " for " +
                       std::to_string(out.vertices.size()));
    out.faces.radius = radius[0];
    return out;
  }
};

/// Any tet of each vertex.
std::vector<Index> tets_of_vertices(const TetMesh& mesh) {
  std::vector<Index> out(mesh.vertices.size(), TetBinding::none);
  for (Index t = 0; t < mesh.tets.size(); ++t)
    for (const Index v : mesh.tets[t])
      if (out[v] == TetBinding::none) out[v] = t;
  return out;
}

class TetDeformer final : public Deformer {
 public:
  static std::unique_ptr<TetDeformer> make(std::shared_ptr<const Shape> rest, const TetOptions& options, TetMesh mesh,
                                           std::vector<std::string> notes,
                                           const std::function<bool(double)>& progress) {
    auto out = std::make_unique<TetDeformer>(std::move(rest), options, std::move(mesh), std::move(notes));
    std::size_t widened = 0;
    out->weights_ = out->surface_.bind(out->rest_->positions, Gradients::No, &widened, progress);
    if (out->weights_.size() != out->rest_->size()) return nullptr;
    if (widened > 0)
      out->notes_.push_back(std::to_string(widened) + (widened == 1 ? " point has" : " points have") +
                            " no face of the solid within 5 % of the diagonal: the nearest ones were taken.");
    return out;
  }

  TetDeformer(std::shared_ptr<const Shape> rest, const TetOptions& options, TetMesh mesh,
              std::vector<std::string> notes)
      : options_(options),
        rest_(std::move(rest)),
        unit_(normalization_of(bounds_of(rest_->positions))),
        mesh_(std::move(mesh)),
        binding_(bind_vertices(mesh_, *rest_)),
        tet_of_vertex_(tets_of_vertices(mesh_)),
        notes_(std::move(notes)) {
    surface_.faces = faces_of(mesh_);
    if (covers_the_surface()) {
      surface_.vertices = mesh_.vertices;
      surface_.vertex_tets = tet_of_vertex_;
    }
    make_solver({});
    publish();
  }

  const SkinWeights& weights() const override { return weights_; }
  SkinWeights bind(std::span<const Vec3> points, Gradients gradients) const override {
    return surface_.bind(points, gradients);
  }
  const Pose& pose() const override { return pose_; }
  std::unique_ptr<Deformer> refined() const override { return nullptr; }
  std::vector<std::string> notes() const override { return notes_; }
  std::vector<Table> binding() const override { return surface_.tables(); }

  std::vector<double> map_energy() const override {
    std::vector<double> out = solver_->energy().tet_energies();
    out.resize(mesh_.tets.size());
    return out;
  }

  Figures counts() const override {
    return {{"tets", static_cast<double>(mesh_.tets.size())}, {"vertices", static_cast<double>(mesh_.vertices.size())}};
  }

  Structure structure() const override {
    Structure out{mesh_.vertices, {}, tet_of_vertex_, mesh_.tets, binding_.point_of_vertex};
    std::set<std::pair<Index, Index>> edges;
    for (const Tet& tet : mesh_.tets)
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = a + 1; b < 4; ++b) edges.emplace(std::min(tet[a], tet[b]), std::max(tet[a], tet[b]));
    out.edges.assign(edges.begin(), edges.end());
    return out;
  }

  void follow(std::shared_ptr<const Shape> rest) override {
    CHECK(rest->size() == rest_->size(), rest->size(), rest_->size());
    // Vertices go with their points; those inside where the solid takes them, bent by its surface.
    Constraints surface;
    Handle handle;
    for (Index v = 0; v < mesh_.vertices.size(); ++v) {
      const Index i = binding_.point_of_vertex[v];
      if (binding_.vertex_of_point[i] != v || !rest->positions[i].allFinite()) continue;
      handle.points.push_back(i);
      handle.targets.push_back(rest->positions[i]);
    }
    surface.handles.push_back(std::move(handle));
    reset();
    solve(surface, {});
    for (Index v = 0; v < mesh_.vertices.size(); ++v) mesh_.vertices[v] = unit_.undo(solver_->x()[v]);
    rest_ = std::move(rest);
    surface_.faces = faces_of(mesh_);
    if (!surface_.vertices.empty()) surface_.vertices = mesh_.vertices;
    make_solver({});
    publish();
  }

  SolveReport solve(const Constraints& constraints, const SolveOptions& options) override {
    const auto begin = Clock::now();
    prepare(constraints);
    const double prefactor = seconds_since(begin);
    // An iteration is a solve with a factor that is there: ten of them cost what one does that makes a factor.
    SolveOptions own = options;
    if (options.quality == SolveOptions::Quality::Final) own.max_iterations *= 10;
    SolveReport report = solver_->solve(targets_of(constraints), own, [&] {
      if (!options.on_iteration) return true;
      publish();
      return options.on_iteration(pose_);
    });
    publish();
    report.prefactor_seconds = prefactor;
    report.counts = {{"unknowns", 3.0 * static_cast<double>(solver_->free_vertices())},
                     {"tets", static_cast<double>(mesh_.tets.size())},
                     {"coarse_vertices", static_cast<double>(mesh_.vertices.size())}};
    measure_handles(constraints, report);
    if (report.message.empty() && solver_->resting_parts() > 0)
      report.message = std::to_string(solver_->resting_parts()) + (solver_->resting_parts() == 1 ? " part" : " parts") +
                       " of the solid rest: nothing of them is "
                       "fixed or a handle";
    return report;
  }

  void reset() override {
    solver_->reset();
    publish();
  }

  void start_from(const Pose& pose) override {
    CHECK(pose.size() == mesh_.tets.size(), pose.size(), mesh_.tets.size());
    std::vector<Vec3> x = solver_->rest();
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
      const Affine& map = pose[tet_of_vertex_[v]];
      x[v] = unit_.apply(map.leftCols<3>() * mesh_.vertices[v] + map.col(3));
    }
    for (std::size_t v = mesh_.vertices.size(); v < x.size(); ++v) x[v] = carried(v, x);
    solver_->set_x(std::move(x));
    publish();
  }

 private:
  /// Whether all points of faces are vertices, so that each can follow its own.
  bool covers_the_surface() const {
    return std::all_of(rest_->faces.points.begin(), rest_->faces.points.end(),
                       [&](Index i) {
                         return binding_.vertex_of_point[i] != TetBinding::none || !rest_->positions[i].allFinite();
                       }) &&
           (!rest_->faces.empty() || !rest_->tets.empty());
  }

  /// A vertex outside goes with the faces it is joined to: where its tets have it in the mean.
  Vec3 carried(std::size_t v, const std::vector<Vec3>& x) const {
    Vec3 moved = Vec3::Zero();
    int count = 0;
    for (const Tet& tet : plan_.extra_tets) {
      if (tet[3] != v) continue;
      for (std::size_t c = 0; c < 3; ++c, ++count) moved += x[tet[c]] - solver_->rest()[tet[c]];
    }
    return solver_->rest()[v] + moved / std::max(count, 1);
  }

  void make_solver(TetPlan plan) {
    plan_ = std::move(plan);
    std::vector<Vec3> vertices;
    for (const Vec3& p : mesh_.vertices) vertices.push_back(unit_.apply(p));
    for (const Vec3& p : plan_.extra_vertices) vertices.push_back(unit_.apply(p));
    std::vector<Tet> tets = mesh_.tets;
    tets.insert(tets.end(), plan_.extra_tets.begin(), plan_.extra_tets.end());
    solver_ = std::make_unique<TetSolver>(std::move(vertices), std::move(tets));
    solver_->set_interpolation(options_.interpolate_rotations);
    prepared_.reset();
  }

  /// What depends on which points are held, not on where they are to be.
  void prepare(const Constraints& constraints) {
    Constraints marks = constraints;
    for (Handle& handle : marks.handles) {
      handle.targets.clear();
      handle.turn.reset();
    }
    const auto same = [](const Constraints& a, const Constraints& b) {
      return a.fixed == b.fixed && a.handles == b.handles && a.rigid == b.rigid && a.stiffness == b.stiffness;
    };
    if (prepared_ && same(*prepared_, marks)) return;
    TetPlan plan = plan_constraints(constraints, mesh_, binding_, *rest_);
    if (plan.extra_vertices != plan_.extra_vertices || plan.extra_tets != plan_.extra_tets) {
      const bool moved = moved_;
      const Pose now = pose_;
      make_solver(std::move(plan));
      if (moved) start_from(now);
    } else {
      plan_ = std::move(plan);
    }
    solver_->prepare(plan_.constraints);
    prepared_ = std::move(marks);
  }

  std::vector<TetTarget> targets_of(const Constraints& constraints) const {
    std::vector<TetTarget> out;
    for (std::size_t h = 0; h < constraints.handles.size(); ++h) {
      const Handle& handle = constraints.handles[h];
      CHECK(handle.points.size() + handle.places.size() == handle.targets.size(), handle.targets.size());
      TetTarget target{{}, handle.turn};
      const TetHandle& held = plan_.constraints.handles[h];
      for (std::size_t k = 0; k < plan_.at[h].size(); ++k) {
        const Vec3& p = handle.targets[plan_.at[h][k]];
        // What has no target stays where it is.
        target.positions.push_back(p.allFinite() ? unit_.apply(p) : place_of(held, k));
      }
      out.push_back(std::move(target));
    }
    if (!plan_.fixed_targets.empty()) {
      out.emplace_back();
      for (const Vec3& p : plan_.fixed_targets) out.back().positions.push_back(unit_.apply(p));
    }
    return out;
  }

  Vec3 place_of(const TetHandle& held, std::size_t k) const {
    if (k < held.vertices.size()) return solver_->x()[held.vertices[k]];
    return held.ties[k - held.vertices.size()].at(solver_->x());
  }

  void measure_handles(const Constraints& constraints, SolveReport& report) const {
    double squares = 0;
    std::size_t count = 0;
    const auto add = [&](double distance) {
      squares += distance * distance;
      report.handle_max = std::max(report.handle_max, distance);
      ++count;
    };
    std::vector<Index> points;
    std::vector<Vec3> targets;
    for (std::size_t h = 0; h < constraints.handles.size(); ++h) {
      const Handle& handle = constraints.handles[h];
      points.insert(points.end(), handle.points.begin(), handle.points.end());
      targets.insert(targets.end(), handle.targets.begin(),
                     handle.targets.begin() + static_cast<std::ptrdiff_t>(handle.points.size()));
      for (std::size_t k = 0; k < plan_.at[h].size(); ++k) {
        const std::size_t i = plan_.at[h][k];
        if (i >= handle.points.size() && handle.targets[i].allFinite())
          add((place_of(plan_.constraints.handles[h], k) - unit_.apply(handle.targets[i])).norm());
      }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3& p = rest_->positions[points[i]];
      Vec3 moved = p;
      for (std::uint64_t e = weights_.offsets[points[i]]; e < weights_.offsets[points[i] + 1]; ++e) {
        const Affine& map = pose_[weights_.maps[e]];
        moved += static_cast<double>(weights_.weights[e]) * (map.leftCols<3>() * p + map.col(3) - p);
      }
      const double distance = unit_.scale * (moved - targets[i]).norm();
      if (std::isfinite(distance)) add(distance);
    }
    if (count > 0) report.handle_rms = std::sqrt(squares / static_cast<double>(count));
  }

  /// x as affine maps in the shape's coordinates: p -> v' + T (p - v), v any corner.
  void publish() {
    const std::vector<Vec3>&x = solver_->x(), &rest = solver_->rest();
    std::vector<bool> moved(mesh_.vertices.size());
    for (std::size_t v = 0; v < moved.size(); ++v) moved[v] = x[v] != rest[v];
    moved_ = std::find(moved.begin(), moved.end(), true) != moved.end();
    pose_.resize(mesh_.tets.size());
    T_.resize(solver_->tets().size());
    solver_->energy().maps(x, T_);
    parallel_for(pose_.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t j = begin; j < end; ++j) {
        const Tet& tet = mesh_.tets[j];
        if (!moved[tet[0]] && !moved[tet[1]] && !moved[tet[2]] && !moved[tet[3]]) {
          pose_[j] = identity_map();
          continue;
        }
        const Vec3& corner = mesh_.vertices[tet[0]];
        pose_[j].leftCols<3>() = T_[j];
        pose_[j].col(3) = corner + (x[tet[0]] - rest[tet[0]]) / unit_.scale - T_[j] * corner;
      }
    });
  }

  TetOptions options_;
  std::shared_ptr<const Shape> rest_;
  Normalization unit_;
  TetMesh mesh_;
  TetBinding binding_;
  std::vector<Index> tet_of_vertex_;
  TetSurface surface_;
  SkinWeights weights_;
  std::vector<std::string> notes_;
  TetPlan plan_;
  std::unique_ptr<TetSolver> solver_;
  std::optional<Constraints> prepared_;  ///< the marks that the solver knows
  Pose pose_;
  std::vector<Mat3> T_;  ///< of the pose, kept for its memory
  bool moved_ = false;   ///< the pose is not at rest
};

const std::vector<Setting>& tet_settings() {
  static const std::vector<Setting> settings = {
      {"vertices",
       5000,
       50,
       1000000,
       "",
       "About how many vertices the surface is simplified to before it is filled with tets.",
       true,
       {}},
      {"filling",
       0,
       0,
       1,
       "",
       "Tets between vertices of the surface alone, or with more inside.",
       false,
       {"surface", "inside"}},
      {"rotations",
       0,
       0,
       1,
       "",
       "Turns of handles are spread over the solid at once, or left for the iterations to find.",
       false,
       {"harmonic", "found"}},
      {"close_holes",
       0,
       0,
       10000,
       "edges",
       "Holes of up to so many edges are closed before the solid is filled.",
       true,
       {}},
      {"patience", 120, 1, 86400, "s", "Making the tets is given up after this long.", false, {}},
  };
  return settings;
}

std::unique_ptr<Deformer> make(std::shared_ptr<const Shape> rest, const Settings& settings,
                               const StructureWishes& wishes, const std::function<bool(double)>& progress) {
  const auto value = [&](const char* name) { return value_of(settings, tet_settings(), name); };
  TetOptions options;
  options.mesh.vertices = static_cast<int>(value("vertices"));
  options.mesh.inside = value("filling") == 1;
  options.mesh.close_holes = static_cast<int>(value("close_holes"));
  options.mesh.max_seconds = value("patience");
  options.interpolate_rotations = value("rotations") == 0;
  options.solid = wishes.solid;
  return make_tet_deformer(std::move(rest), options, progress);
}

SkinWeights bind_from_tables(const std::vector<Deformer::Table>& binding, std::span<const Vec3> points,
                             Gradients gradients) {
  return TetSurface::from_tables(binding).bind(points, gradients);
}

}  // namespace

std::unique_ptr<Deformer> make_tet_deformer(std::shared_ptr<const Shape> rest, const TetOptions& options,
                                            const std::function<bool(double)>& progress) {
  std::vector<std::string> notes;
  std::optional<TetMesh> mesh;
  if (options.solid != nullptr)
    mesh = tet_mesh_of(*options.solid, notes);
  else if (!rest->tets.empty())
    mesh = tet_mesh_of(*rest, notes);
  else
    mesh = tetrahedralized(*rest, options.mesh, notes, [&](double done) { return !progress || progress(0.6 * done); });
  if (!mesh) return nullptr;
  if (options.solid != nullptr) mesh->points.clear();  // they are points of that shape, not of this
  const auto binding = [&](double done) { return !progress || progress(0.6 + 0.4 * done); };
  return TetDeformer::make(std::move(rest), options, std::move(*mesh), std::move(notes), binding);
}

Method tet_method() {
  return {"tet",
          "A solid of tetrahedra: bends closed shapes and keeps their volume.",
          tet_settings(),
          make,
          bind_from_tables,
          {.rigid = true, .stiffness = true, .places = true, .solid = true}};
}

}  // namespace sinew
