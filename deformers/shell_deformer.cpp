#include "deformers/shell.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "deformers/shell_coarse.h"
#include "deformers/shell_path.h"
#include "deformers/shell_pose.h"
#include "deformers/shell_solver.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/check.h"

namespace sinew {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

class ShellDeformer final : public Deformer {
 public:
  ShellDeformer(std::shared_ptr<const Shape> rest, ShellMesh mesh, std::unique_ptr<ShellCoarse> coarse,
                const ShellOptions& options)
      : options_(options),
        rest_(std::move(rest)),
        unit_(normalization_of(bounds_of(rest_->positions))),
        mesh_(std::move(mesh)),
        coarse_(std::move(coarse)) {
    make_solver();
    bind_own_points();
    publish();
  }

  const SkinWeights& weights() const override { return weights_; }
  SkinWeights bind(std::span<const Vec3> points, Gradients gradients) const override {
    return surface().bind(points, gradients);
  }
  const Pose& pose() const override { return pose_; }
  std::unique_ptr<Deformer> refined() const override { return nullptr; }
  std::vector<Table> binding() const override { return surface().tables(); }

  std::vector<double> map_energy() const override {
    std::vector<double> out = solver_->energy().vertex_energies(solver_->x());
    if (coarse_) out = coarse_->fine_values(out);
    out.resize(pose_.size(), 0);
    return out;
  }

  Structure structure() const override {
    Structure out;
    for (Index v = 0; v < solver_->x().size(); ++v) {
      const Index fine = coarse_ ? coarse_->vertices()[v] : v;
      out.vertices.push_back(mesh_.rest()[fine]);
      out.maps.push_back(fine);
      out.points.push_back(mesh_.point_of_vertex[fine]);
    }
    for (const ShellEdge& e : solver_->energy().edges()) out.edges.emplace_back(e.x[0], e.x[1]);
    return out;
  }

  Figures counts() const override {
    return {{"vertices", static_cast<double>(mesh_.size())},
            {"coarse_vertices", coarse_ ? static_cast<double>(coarse_->vertices().size()) : 0},
            {"edges", static_cast<double>(solver_->energy().edges().size())}};
  }

  std::vector<std::string> notes() const override {
    std::vector<std::string> out = mesh_.notes;
    if (!solver_->energy().keeps_volume() && options_.stiffness.nu > 0)
      out.push_back("The surface does not enclose a volume: none is kept.");
    if (const std::size_t folds = solver_->energy().folds(); folds > 0)
      out.push_back(std::to_string(folds) + (folds == 1 ? " edge is" : " edges are") +
                    " folded the other way in an example: no bending is measured there.");
    return out;
  }

  void follow(std::shared_ptr<const Shape> rest) override {
    CHECK(rest->size() == rest_->size(), rest->size(), rest_->size());
    rest_ = std::move(rest);
    for (Index v = 0; v < mesh_.size(); ++v) mesh_.poses[0][v] = rest_->positions[mesh_.point_of_vertex[v]];
    if (coarse_) coarse_->forget_rest();
    make_solver();
    start_from(Pose(pose_));
  }

  SolveReport solve(const Constraints& constraints, const SolveOptions& options) override {
    const auto begin = Clock::now();
    hold(constraints);
    solver_->prepare(held_of(constraints));
    const double prefactor = seconds_since(begin);
    const ShellPath path = path_of(constraints);
    const auto targets = [&](double share) { return solver_targets(path.at(share)); };
    const auto published = [&] {
      if (!options.on_iteration) return true;
      publish();
      return options.on_iteration(pose_);
    };
    // From rest to the final answer, without examples to lead the way.
    const bool twice = options.quality == SolveOptions::Quality::Final && mesh_.poses.size() == 1 &&
                       path.stretches() > 1 && solver_->x() == solver_->rest();
    SolveReport report = twice ? solver_->solve_twice(targets, path.stretches(), options, published)
                               : solver_->solve(targets, path.stretches(), options, published);
    const auto refining = Clock::now();
    publish();
    if (coarse_ && options.quality == SolveOptions::Quality::Final && report.status != Status::Stopped)
      reconstruct(report, options);
    report.solve_seconds += seconds_since(refining);
    report.prefactor_seconds = prefactor;
    report.counts = {{"unknowns", 3.0 * static_cast<double>(solver_->free_vertices()) + unknown_weights(constraints)}};
    measure_handles(constraints, report);
    if (report.message.empty() && solver_->resting_parts() > 0)
      report.message = std::to_string(solver_->resting_parts()) + (solver_->resting_parts() == 1 ? " part" : " parts") +
                       " of the surface rest: nothing of them is fixed or a handle";
    return report;
  }

  void reset() override {
    solver_->reset();
    held_.clear();
    for (Loose& loose : loose_) loose.held.reset();
    publish();
  }

  void start_from(const Pose& pose) override {
    CHECK(pose.size() == mesh_.size() + loose_.size(), pose.size(), mesh_.size(), loose_.size());
    std::vector<Vec3> x;
    for (Index v = 0; v < solver_->x().size(); ++v) {
      const Index fine = coarse_ ? coarse_->vertices()[v] : v;
      const Vec3& p = mesh_.rest()[fine];
      x.push_back(pose[fine] == identity_map() ? solver_->rest()[v]
                                               : unit_.apply(pose[fine].leftCols<3>() * p + pose[fine].col(3)));
    }
    solver_->set_x(std::move(x));
    pose_ = pose;
  }

 private:
  /// A fine vertex that is fixed or of a handle.
  struct Held {
    static constexpr Index fixed = ~Index{0};
    Index vertex = 0;
    Vec3 target = Vec3::Zero();  ///< in the shape's coordinates
    Index handle = fixed;
  };

  ShellSurface surface() const { return {mesh_.rest(), mesh_.triangles}; }

  void make_solver() {
    solver_ = solver_of(coarse_.get());
    fine_solver_.reset();
  }

  /// Of the coarse vertices, or of all of them.
  std::unique_ptr<ShellSolver> solver_of(const ShellCoarse* coarse) const {
    const auto normalised = [&](const std::vector<Vec3>& pose) {
      std::vector<Vec3> out = coarse != nullptr && !pose.empty() ? coarse->coarse_of(pose) : pose;
      for (Vec3& p : out) p = unit_.apply(p);
      return out;
    };
    std::vector<std::vector<Vec3>> poses;
    for (const std::vector<Vec3>& pose : mesh_.poses) poses.push_back(normalised(pose));
    return std::make_unique<ShellSolver>(std::move(poses), coarse != nullptr ? coarse->triangles() : mesh_.triangles,
                                         options_.stiffness, normalised(mesh_.source));
  }

  /// A point on no face: it has a map of its own, that of the nearest place of the surface unless it is held.
  struct Loose {
    Index point = 0;
    Triangle corners{};
    Vec3 weights = Vec3::Zero();
    std::optional<Held> held = {};
  };

  void bind_own_points() {
    std::vector<Vec3> places;
    loose_.clear();
    for (Index i = 0; i < rest_->size(); ++i) {
      if (mesh_.vertex_of_point[i] != ShellMesh::none || !rest_->positions[i].allFinite()) continue;
      loose_.push_back({i});
      places.push_back(rest_->positions[i]);
    }
    if (!loose_.empty()) {
      const std::vector<ShellSurface::Foot> feet = surface().feet(places);
      for (std::size_t k = 0; k < loose_.size(); ++k) {
        loose_[k].corners = mesh_.triangles[feet[k].triangle];
        loose_[k].weights = feet[k].weights;
      }
    }
    weights_ = {};
    Index next = static_cast<Index>(mesh_.size());
    for (std::size_t i = 0; i < rest_->size(); ++i) {
      const Index v = mesh_.vertex_of_point[i];
      if (v != ShellMesh::none || rest_->positions[i].allFinite()) {
        weights_.maps.push_back(v != ShellMesh::none ? v : next++);
        weights_.weights.push_back(1);
      }
      weights_.offsets.push_back(weights_.maps.size());
    }
  }

  /// The map of a loose point, ascending by point; null where the point is at a vertex, or not finite.
  Loose* loose_at(Index point) {
    const auto at = std::lower_bound(loose_.begin(), loose_.end(), point,
                                     [](const Loose& loose, Index wanted) { return loose.point < wanted; });
    return at != loose_.end() && at->point == point ? &*at : nullptr;
  }

  /// Which vertices are held and where, and how stiff all are. One that is fixed and of a handle goes with the handle;
  /// of two handles, with the first. What has no target stays where it is.
  void hold(const Constraints& constraints) {
    std::vector<bool> taken(mesh_.size(), false);
    std::vector<Held> held;
    for (Loose& loose : loose_) loose.held.reset();
    const auto add = [&](Index point, const Vec3& target, Index handle) {
      const Index v = mesh_.vertex_of_point[point];
      if (Loose* loose = loose_at(point); loose != nullptr && !loose->held && target.allFinite())
        loose->held = Held{0, target, handle};
      if (v == ShellMesh::none || taken[v]) return;
      taken[v] = true;
      held.push_back({v, target.allFinite() ? target : moved(v), handle});
    };
    for (Index h = 0; h < constraints.handles.size(); ++h) {
      const Handle& handle = constraints.handles[h];
      for (std::size_t k = 0; k < handle.points.size(); ++k) add(handle.points[k], handle.targets[k], h);
    }
    for (const Index i : constraints.fixed) add(i, rest_->positions[i], Held::fixed);
    std::sort(held.begin(), held.end(), [](const Held& a, const Held& b) { return a.vertex < b.vertex; });
    held_ = std::move(held);
    stiffness_.clear();
    for (const Stiff& stiff : constraints.stiffness) {
      std::vector<double> factors(mesh_.size(), 1);
      for (const Index i : stiff.points)
        if (const Index v = mesh_.vertex_of_point[i]; v != ShellMesh::none) factors[v] = stiff.factor;
      stiffness_.resize(mesh_.size(), 1);
      for (Index v = 0; v < stiffness_.size(); ++v) stiffness_[v] *= factors[v];
    }
  }

  Vec3 moved(Index v) const {
    const Vec3& p = mesh_.rest()[v];
    return p + (pose_[v].leftCols<3>() * p - p + pose_[v].col(3));
  }

  /// From where the held vertices are to their targets, each handle as a rigid body.
  ShellPath path_of(const Constraints& constraints) const {
    ShellPath path(held_.size());
    std::vector<std::vector<Index>> of_handle(constraints.handles.size());
    for (Index k = 0; k < held_.size(); ++k) {
      path.set(k, moved(held_[k].vertex), held_[k].target);
      if (held_[k].handle != Held::fixed) of_handle[held_[k].handle].push_back(k);
    }
    for (std::size_t h = 0; h < of_handle.size(); ++h) {
      const bool at_rest = std::all_of(of_handle[h].begin(), of_handle[h].end(),
                                       [&](Index k) { return pose_[held_[k].vertex] == identity_map(); });
      path.add_body(of_handle[h], at_rest ? constraints.handles[h].turn : std::nullopt, 1 / unit_.scale);
    }
    return path;
  }

  /// What the solver holds: vertices; of a coarse mesh, ties for those between its vertices, unless all of these are
  /// held. Notes which of held_ each is.
  ShellHeld held_of(const Constraints& constraints) {
    ShellHeld out;
    out.weights = constraints.example_weights;
    solver_held_.clear();
    std::vector<bool> exact(solver_->x().size(), false);
    for (Index k = 0; k < held_.size(); ++k) {
      const Index v = coarse_ ? coarse_->number_of(held_[k].vertex) : held_[k].vertex;
      if (v == ShellCoarse::none) continue;
      exact[v] = true;
      out.vertices.push_back(v);
      solver_held_.push_back(k);
    }
    for (Index k = 0; k < held_.size() && coarse_; ++k) {
      const Index fine = held_[k].vertex;
      if (coarse_->number_of(fine) != ShellCoarse::none) continue;
      ShellTie tie = coarse_->tie_of(fine, mesh_.rest());
      if (std::all_of(tie.corners.begin(), tie.corners.end(), [&](Index v) { return exact[v]; })) continue;
      tie.height *= unit_.scale;
      out.ties.push_back(tie);
      solver_held_.push_back(k);
    }
    if (!stiffness_.empty())
      for (Index v = 0; v < solver_->x().size(); ++v)
        out.stiffness.push_back(stiffness_[coarse_ ? coarse_->vertices()[v] : v]);
    return out;
  }

  std::vector<Vec3> solver_targets(const std::vector<Vec3>& held) const {
    std::vector<Vec3> out;
    for (const Index k : solver_held_) out.push_back(unit_.apply(held[k]));
    return out;
  }

  double unknown_weights(const Constraints& constraints) const {
    const auto& given = constraints.example_weights;
    const auto pinned = std::count_if(given.begin(), given.end(), [](const auto& w) { return w.has_value(); });
    return static_cast<double>(solver_->alpha().size()) - static_cast<double>(pinned);
  }

  void measure_handles(const Constraints& constraints, SolveReport& report) const {
    double squares = 0;
    std::size_t count = 0;
    for (const Handle& handle : constraints.handles)
      for (std::size_t k = 0; k < handle.points.size(); ++k) {
        const Index v = mesh_.vertex_of_point[handle.points[k]];
        const double distance = v == ShellMesh::none ? NAN : unit_.scale * (moved(v) - handle.targets[k]).norm();
        if (!std::isfinite(distance)) continue;
        squares += distance * distance;
        report.handle_max = std::max(report.handle_max, distance);
        ++count;
      }
    if (count > 0) report.handle_rms = std::sqrt(squares / static_cast<double>(count));
  }

  /// A solver's vertices in the shape's coordinates, to the last bit where they did not move.
  std::vector<Vec3> in_shape(const ShellSolver& solver, const ShellCoarse* coarse) const {
    const std::vector<Vec3>&x = solver.x(), &rest = solver.rest();
    std::vector<Vec3> out(x.size());
    for (std::size_t v = 0; v < x.size(); ++v)
      out[v] = x[v] == rest[v] ? mesh_.rest()[coarse != nullptr ? coarse->vertices()[v] : v] : unit_.undo(x[v]);
    return out;
  }
  std::vector<Vec3> solved() const { return in_shape(*solver_, coarse_.get()); }

  void publish() {
    if (coarse_)
      pose_ = coarse_->fine_maps(vertex_maps(coarse_->coarse_of(mesh_.rest()), solved(), coarse_->triangles()));
    else
      pose_ = vertex_maps(mesh_.rest(), solved(), mesh_.triangles);
    meet_exactly();
  }

  /// What is held is where it is to be, whatever the structure; what is fixed is not turned either. Adds the maps of
  /// loose points.
  void meet_exactly() {
    const auto meet = [](const Held& held, const Vec3& rest, Affine& map) {
      if (held.handle == Held::fixed)
        map = identity_map();
      else
        map.col(3) = held.target - map.leftCols<3>() * rest;
    };
    for (const Held& h : held_) meet(h, mesh_.rest()[h.vertex], pose_[h.vertex]);
    pose_.resize(mesh_.size());
    for (const Loose& loose : loose_) {
      Affine map = identity_map();
      for (std::size_t k = 0; k < 3; ++k)
        map += loose.weights[static_cast<Eigen::Index>(k)] * (pose_[loose.corners[k]] - identity_map());
      if (loose.held) meet(*loose.held, rest_->positions[loose.point], map);
      pose_.push_back(map);
    }
  }

  void reconstruct(SolveReport& report, const SolveOptions& options) {
    std::vector<Index> held;
    std::vector<Vec3> targets;
    for (const Held& h : held_) {
      held.push_back(h.vertex);
      targets.push_back(h.target);
    }
    const auto progress = [&](double) { return !options.on_iteration || options.on_iteration(pose_); };
    const std::vector<Vec3> fine = coarse_->reconstruct(mesh_, solved(), held, targets, progress);
    if (fine.empty()) {
      report.status = Status::Stopped;
      return;
    }
    pose_ = vertex_maps(mesh_.rest(), fine, mesh_.triangles);
    meet_exactly();
    if (options_.finish == ShellOptions::Finish::Solved) solve_fine(report, options, fine);
  }

  /// All vertices from where they were reconstructed, with the weights that were found [section 7].
  void solve_fine(SolveReport& report, const SolveOptions& options, const std::vector<Vec3>& from) {
    if (fine_solver_ == nullptr) fine_solver_ = solver_of(nullptr);
    ShellHeld held;
    std::vector<Vec3> targets, x;
    for (const Held& h : held_) {
      held.vertices.push_back(h.vertex);
      targets.push_back(unit_.apply(h.target));
    }
    held.stiffness = stiffness_;
    held.weights.assign(solver_->alpha().begin(), solver_->alpha().end());
    for (std::size_t v = 0; v < from.size(); ++v)
      x.push_back(from[v] == mesh_.rest()[v] ? fine_solver_->rest()[v] : unit_.apply(from[v]));
    fine_solver_->prepare(held);
    fine_solver_->set_x(std::move(x));
    SolveOptions few = options;
    few.max_iterations = std::min(options.max_iterations, 4);
    const SolveReport fine = fine_solver_->solve([&](double) { return targets; }, 1, few,
                                                 [&] { return !options.on_iteration || options.on_iteration(pose_); });
    report.iterations += fine.iterations;
    report.energy = fine.energy;
    if (fine.status == Status::Stopped || fine.status == Status::Failed) report.status = fine.status;
    pose_ = vertex_maps(mesh_.rest(), in_shape(*fine_solver_, nullptr), mesh_.triangles);
    meet_exactly();
  }

  ShellOptions options_;
  std::shared_ptr<const Shape> rest_;
  Normalization unit_;
  ShellMesh mesh_;
  std::unique_ptr<ShellCoarse> coarse_;  ///< null: the shape's own vertices are solved for
  std::unique_ptr<ShellSolver> solver_;
  std::unique_ptr<ShellSolver>
      fine_solver_;  ///< of all vertices, where they are solved for at the end; null until then
  std::vector<Loose> loose_;
  std::vector<Held> held_;          ///< ascending
  std::vector<double> stiffness_;   ///< of each vertex; empty: all as they are
  std::vector<Index> solver_held_;  ///< of what the solver holds, which of held_ it is
  SkinWeights weights_;
  Pose pose_;
};

}  // namespace

std::unique_ptr<Deformer> make_shell_deformer(std::shared_ptr<const Shape> rest,
                                              std::span<const std::shared_ptr<const Shape>> examples,
                                              const ShellOptions& options, const std::function<bool(double)>& progress,
                                              const Shape* source) {
  ShellMesh mesh = shell_mesh_of(*rest, examples, source);
  if (progress && !progress(0.1)) return nullptr;
  std::unique_ptr<ShellCoarse> coarse;
  if (options.vertices > 0 && mesh.size() > 2 * options.vertices) {
    coarse = ShellCoarse::make(mesh, options.vertices, progress);
    if (coarse == nullptr) return nullptr;
  }
  return std::make_unique<ShellDeformer>(std::move(rest), std::move(mesh), std::move(coarse), options);
}

}  // namespace sinew
