#include "deformers/graph.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>

#include "deformers/graph_influence.h"
#include "deformers/graph_nodes.h"
#include "deformers/graph_refine.h"
#include "deformers/graph_solver.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/error.h"
#include "engine/geometry/skin.h"

namespace sinew {

namespace {

std::vector<Vec3> choose_nodes(const Shape& shape, const GraphOptions& options, std::vector<std::string>& notes) {
  std::vector<Vec3> nodes;
  for (const Index i : options.given) {
    if (i >= shape.size() || !shape.positions[i].allFinite())
      throw InputError("graph nodes: expected finite points of the shape, found index " + std::to_string(i));
    nodes.push_back(shape.positions[i]);
  }
  if (!nodes.empty()) return nodes;
  const auto count = static_cast<std::size_t>(options.nodes);
  if (options.simplify) {
    if (shape.faces.empty())
      throw InputError(
          "graph nodes: expected a shape with faces to simplify, found points only; choose sampling \"radius\"");
    std::string note;
    nodes = simplify_to_nodes(shape, count, note);
    if (!note.empty()) notes.push_back(note);
  } else {
    nodes = sample_nodes(shape, count, options.seed);
  }
  if (nodes.empty()) throw InputError("graph nodes: expected at least one point with finite coordinates, found none");
  return nodes;
}

/// The finite point of the shape nearest to each of `to`.
std::vector<Index> nearest_points(const Shape& shape, std::span<const Vec3> to) {
  std::vector<Index> finite;
  std::vector<Vec3> points;
  for (Index i = 0; i < shape.size(); ++i)
    if (shape.positions[i].allFinite()) {
      finite.push_back(i);
      points.push_back(shape.positions[i]);
    }
  std::vector<Index> near(to.size());
  std::vector<double> distance(to.size());
  NearestTree(points).nearest(to, 1, near, distance);
  for (Index& i : near) i = finite[i];
  return near;
}

/// A graph is fine enough where what the maps of neighbouring nodes make of the edge between them differs by this part
/// of its length (rms): half a degree of bend.
constexpr double fine_enough = 0.01;

class GraphDeformer final : public Deformer {
 public:
  /// Null where progress said false.
  static std::unique_ptr<GraphDeformer> make(std::shared_ptr<const Shape> rest, const GraphOptions& options,
                                             std::vector<Vec3> nodes, std::vector<std::string> chosen_notes,
                                             const std::function<bool(double)>& progress) {
    GraphInfluence influence(nodes, {options.neighbours, options.surface, options.cuts});
    std::vector<std::string> notes = chosen_notes;
    std::optional<GraphInfluence::Bound> bound = influence.bind_shape(*rest, notes, progress);
    if (!bound) return nullptr;
    if (options.chain) {
      CHECK(!options.given.empty());
      bound->edges.clear();
      for (Index j = 0; j + 1 < nodes.size(); ++j) bound->edges.emplace_back(j, j + 1);
    }
    auto out = std::make_unique<GraphDeformer>(std::move(rest), options, std::move(nodes), std::move(influence),
                                               std::move(*bound), std::move(notes));
    out->chosen_notes_ = std::move(chosen_notes);
    return out;
  }

  GraphDeformer(std::shared_ptr<const Shape> rest, const GraphOptions& options, std::vector<Vec3> nodes,
                GraphInfluence influence, GraphInfluence::Bound bound, std::vector<std::string> notes)
      : options_(options),
        made_on_(rest),
        rest_(std::move(rest)),
        unit_(normalization_of(bounds_of(rest_->positions))),
        nodes_(std::move(nodes)),
        made_nodes_(nodes_),
        chosen_(nodes_.size()),
        influence_(std::move(influence)),
        weights_(std::move(bound.weights)),
        notes_(std::move(notes)),
        solver_(normalised(nodes_), std::move(bound.edges),
                {options.w_rot, options.w_reg, options.w_con, options.chain ? 0.1 : 0}, options.plain) {
    publish();
  }

  const SkinWeights& weights() const override { return weights_; }
  SkinWeights bind(std::span<const Vec3> points, Gradients gradients) const override {
    return influence_.bind(points, gradients);
  }
  const Pose& pose() const override { return pose_; }
  std::vector<double> map_energy() const override { return solver_.node_energy(); }

  std::unique_ptr<Deformer> refined() const override {
    if (options_.chain || nodes_.size() >= static_cast<std::size_t>(options_.adapt)) return nullptr;
    const std::vector<double> energy = map_energy();
    if (is_fine_enough(std::accumulate(energy.begin(), energy.end(), 0.0))) return nullptr;

    // Where the structure was made, not where it followed to: the weights are bound once.
    std::vector<Vec3> nodes = made_nodes_;
    for (const Vec3& p : nodes_added(energy)) nodes.push_back(p);
    if (nodes.size() == nodes_.size()) return nullptr;
    auto finer = make(made_on_, options_, std::move(nodes), chosen_notes_, {});
    finer->chosen_ = chosen_;
    if (rest_ != made_on_) finer->follow(rest_);
    finer->start_where(*this);
    return finer;
  }

  void follow(std::shared_ptr<const Shape> rest) override {
    CHECK(rest->size() == rest_->size(), rest->size(), rest_->size());
    if (carriers_.empty()) {
      carriers_ = nearest_points(*rest_, nodes_);
      for (const Index i : carriers_) carrier_rest_.push_back(rest_->positions[i]);
    }
    // A node between points keeps its place beside the nearest one. From where it was made: steps from frame to frame
    // would add up roundings, and the answer depend in its last digits on the frames before.
    for (std::size_t j = 0; j < nodes_.size(); ++j) {
      const Vec3 moved = rest->positions[carriers_[j]] - carrier_rest_[j];
      nodes_[j] = moved.allFinite() ? made_nodes_[j] + moved : made_nodes_[j];
    }
    rest_ = std::move(rest);
    influence_.follow(nodes_, *rest_);
    solver_.move_nodes(normalised(nodes_));
    prepared_ = false;
    publish();
  }

  std::vector<std::string> notes() const override {
    std::vector<std::string> out = notes_;
    if (const std::size_t added = nodes_.size() - chosen_; added > 0)
      out.push_back(std::to_string(added) + (added == 1 ? " node was" : " nodes were") + " added to the " +
                    std::to_string(chosen_) + " chosen, where the edit bends more than these could follow.");
    return out;
  }

  Figures counts() const override {
    return {{"nodes", static_cast<double>(nodes_.size())}, {"edges", static_cast<double>(solver_.edges().size())}};
  }

  SolveReport solve(const Constraints& constraints, const SolveOptions& options) override {
    const auto start = std::chrono::steady_clock::now();
    std::vector<Vec3> targets;
    std::vector<Index> handle_points;
    for (const Handle& handle : constraints.handles) {
      CHECK(handle.points.size() == handle.targets.size(), handle.points.size(), handle.targets.size());
      for (std::size_t i = 0; i < handle.points.size(); ++i) {
        // A point that is not finite follows nothing and can hold nothing.
        const Index point = handle.points[i];
        if (row_empty(point) || !rest_->positions[point].allFinite() || !handle.targets[i].allFinite()) continue;
        handle_points.push_back(handle.points[i]);
        targets.push_back(unit_.apply(handle.targets[i]));
      }
    }
    if (!prepared_ || constraints.fixed != fixed_ || handle_points != handle_points_)
      prepare(constraints.fixed, std::move(handle_points));
    const double prefactor = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    SolveReport report = solver_.solve(targets, options, [&] {
      if (!options.on_iteration) return true;
      publish();
      return options.on_iteration(pose_);
    });
    report.prefactor_seconds = prefactor;
    publish();
    return report;
  }

  void reset() override {
    solver_.set_x(GraphState::rest(nodes_.size()));
    publish();
  }

  void start_from(const Pose& pose) override {
    CHECK(pose.size() == nodes_.size(), pose.size(), nodes_.size());
    GraphState x = GraphState::rest(nodes_.size());
    for (std::size_t j = 0; j < pose.size(); ++j) {
      x.R[j] = pose[j].leftCols<3>();
      x.t[j] = unit_.scale * (x.R[j] * nodes_[j] + pose[j].col(3) - nodes_[j]);
    }
    solver_.set_x(std::move(x));
    publish();
  }

  Structure structure() const override {
    Structure out{nodes_, {solver_.edges().begin(), solver_.edges().end()}, {}};
    for (Index j = 0; j < nodes_.size(); ++j) out.maps.push_back(j);
    return out;
  }

  std::vector<Table> binding() const override { return influence_.tables(); }

 private:
  std::vector<Vec3> normalised(const std::vector<Vec3>& points) const {
    std::vector<Vec3> out;
    for (const Vec3& p : points) out.push_back(unit_.apply(p));
    return out;
  }

  bool row_empty(Index point) const {
    CHECK(point < weights_.size(), point, weights_.size());
    return weights_.offsets[point] == weights_.offsets[point + 1];
  }

  void prepare(const std::vector<Index>& fixed, std::vector<Index> handle_points) {
    fixed_ = fixed;
    handle_points_ = std::move(handle_points);
    std::vector<bool> fixed_node(nodes_.size(), false);
    for (const Index i : fixed_) {
      CHECK(i < weights_.size(), i, weights_.size());
      for (std::uint64_t e = weights_.offsets[i]; e < weights_.offsets[i + 1]; ++e) fixed_node[weights_.maps[e]] = true;
    }
    std::vector<GraphHandle> handles;
    for (const Index i : handle_points_) {
      GraphHandle handle{unit_.apply(rest_->positions[i]), {}, {}};
      for (std::uint64_t e = weights_.offsets[i]; e < weights_.offsets[i + 1]; ++e) {
        handle.nodes.push_back(weights_.maps[e]);
        handle.weights.push_back(weights_.weights[e]);
      }
      handles.push_back(std::move(handle));
    }
    solver_.prepare(fixed_node, std::move(handles));
    prepared_ = true;
  }

  /// x as affine maps in the shape's coordinates: [R | g + t - R g] with g, t in its unit.
  void publish() {
    const GraphState& x = solver_.x();
    pose_.resize(nodes_.size());
    for (std::size_t j = 0; j < nodes_.size(); ++j)
      pose_[j] << x.R[j], nodes_[j] + x.t[j] / unit_.scale - x.R[j] * nodes_[j];
  }

  bool is_fine_enough(double energy) const {
    double squares = 0;
    for (const auto& [j, k] : solver_.edges()) squares += 2 * (nodes_[j] - nodes_[k]).squaredNorm();
    squares *= unit_.scale * unit_.scale;
    constexpr double rounding = 1e-20;  // all at rest
    return !(energy > options_.w_reg * fine_enough * fine_enough * squares + rounding);
  }

  /// Places for new nodes, where the energy is; on the shape that the structure was made on.
  std::vector<Vec3> nodes_added(const std::vector<double>& energy) const {
    const auto most = static_cast<std::size_t>(options_.adapt);
    const std::vector<Vec3> candidates = node_candidates(*made_on_, most, options_.seed);
    const SkinWeights weights = rest_ == made_on_
                                    ? influence_.bind(candidates, Gradients::No)
                                    : make(made_on_, options_, made_nodes_, {}, {})->bind(candidates, Gradients::No);
    const std::vector<Index> marked = marked_nodes(energy);
    std::vector<Vec3> out;
    for (const Index i :
         candidates_to_add(candidates, weights, made_nodes_, solver_.edges(), marked, most - nodes_.size()))
      out.push_back(candidates[i]);
    return out;
  }

  /// x such that the shape stays where `coarser` has it: the nodes that are its own keep their maps, the others, behind
  /// them, have what it blends at their places.
  void start_where(const GraphDeformer& coarser) {
    const std::size_t own = coarser.nodes_.size();
    Pose pose = coarser.pose_;
    const std::vector<Vec3> added(nodes_.begin() + static_cast<std::ptrdiff_t>(own), nodes_.end());
    const SkinWeights weights = coarser.bind(added, Gradients::No);
    std::vector<Vec3> moved(added.size());
    std::vector<Mat3> M(added.size());
    skin_points(weights, coarser.pose_, added, moved);
    blend_matrices(weights, coarser.pose_, 0, M);
    for (std::size_t i = 0; i < added.size(); ++i) {
      pose.emplace_back();
      pose.back() << M[i], moved[i] - M[i] * added[i];
    }
    start_from(pose);
  }

  GraphOptions options_;
  std::shared_ptr<const Shape> made_on_, rest_;  ///< where the structure was made, and where it is
  Normalization unit_;
  std::vector<Vec3> nodes_, made_nodes_;  ///< where they are, and where they were made
  std::size_t chosen_;                    ///< the first of the nodes: those that refined() did not add
  GraphInfluence influence_;
  SkinWeights weights_;
  std::vector<std::string> chosen_notes_, notes_;  ///< on choosing nodes; these and those on binding
  GraphSolver solver_;
  std::vector<Index> fixed_, handle_points_;
  std::vector<Index> carriers_;     ///< of each node, the point of the shape that carries it; empty until follow()
  std::vector<Vec3> carrier_rest_;  ///< where those points were when the structure was made
  bool prepared_ = true;            ///< the solver knows the constraints and where the nodes are
  Pose pose_;
};

const std::vector<Setting>& graph_settings() {
  static const std::vector<Setting> settings = {
      {"nodes", 250, 1, 100000, "", "How many nodes the graph has; 200 to 300 pose a whole body.", true, {}},
      {"neighbours", 4, 1, 32, "", "How many nodes a point follows; 8 smooths over a regular graph.", true, {}},
      {"distance",
       0,
       0,
       1,
       "",
       "How far a node is from a point: straight, or along the surface, which keeps apart what only lies side by side.",
       false,
       {"straight", "surface"}},
      {"sampling",
       0,
       0,
       1,
       "",
       "How nodes are chosen: evenly over the surface, or by simplifying the faces.",
       false,
       {"radius", "simplify"}},
      {"adapt",
       0,
       0,
       100000,
       "",
       "Where the edit bends more than the nodes can follow, others are added, up to this many in all; 0 adds none.",
       true,
       {}},
      {"seed", 0, 0, 1e9, "", "Another number gives another random sampling.", true, {}},
      {"rotation", 1, 0, 1e9, "", "Weight of staying rigid locally (w_rot).", false, {}},
      {"regularization",
       10,
       0,
       1e9,
       "1/diagonal^2",
       "Weight of agreement between neighbouring nodes (w_reg).",
       false,
       {}},
      {"constraint", 100, 0, 1e9, "1/diagonal^2", "Weight of reaching the handles (w_con).", false, {}},
      {"solver",
       0,
       0,
       1,
       "",
       "\"fast\" keeps factors and starts rigid; \"plain\" is the paper's Gauss-Newton.",
       false,
       {"fast", "plain"}},
  };
  return settings;
}

std::unique_ptr<Deformer> make(std::shared_ptr<const Shape> rest, const Settings& settings,
                               const StructureWishes& wishes, const std::function<bool(double)>& progress) {
  const auto value = [&](const char* name) { return value_of(settings, graph_settings(), name); };
  GraphOptions options;
  options.nodes = static_cast<int>(value("nodes"));
  options.adapt = static_cast<int>(value("adapt"));
  options.neighbours = static_cast<int>(value("neighbours"));
  options.surface = value("distance") == 1;
  options.cuts.assign(wishes.cuts.begin(), wishes.cuts.end());
  options.simplify = value("sampling") == 1;
  options.seed = static_cast<std::uint64_t>(value("seed"));
  options.w_rot = value("rotation");
  options.w_reg = value("regularization");
  options.w_con = value("constraint");
  options.plain = value("solver") == 1;
  options.given.assign(wishes.points.begin(), wishes.points.end());
  options.chain = wishes.chain;
  return make_graph_deformer(std::move(rest), options, progress);
}

SkinWeights bind_from_tables(const std::vector<Deformer::Table>& binding, std::span<const Vec3> points,
                             Gradients gradients) {
  return GraphInfluence::from_tables(binding).bind(points, gradients);
}

}  // namespace

std::unique_ptr<Deformer> make_graph_deformer(std::shared_ptr<const Shape> rest, const GraphOptions& options,
                                              const std::function<bool(double)>& progress) {
  std::vector<std::string> notes;
  std::vector<Vec3> nodes = choose_nodes(*rest, options, notes);
  if (progress && !progress(0.2)) return nullptr;
  const auto binding = [&](double done) { return !progress || progress(0.2 + 0.8 * done); };
  return GraphDeformer::make(std::move(rest), options, std::move(nodes), std::move(notes), binding);
}

Method graph_method() {
  return {"graph",          "A graph of affine maps: bends anything that is points in space.",
          graph_settings(), make,
          bind_from_tables, {.nodes = true, .cuts = true}};
}

}  // namespace sinew
