#pragma once
/// Solves a deformation graph for changing handles: what depends on which points are fixed or handles is prepared when
/// the sets change, what depends on the targets alone is cheap. Works in normalised coordinates.
///
/// Nodes may move from frame to frame (mesh animations): ordering and symbolic analysis then stay. A factor does not:
/// bent joints bend the softest motions with them, and an earlier frame's factor, even turned with each node, takes
/// three times the steps.

#include <vector>

#include "deformers/gauss_newton.h"
#include "deformers/graph_energy.h"
#include "deformers/graph_polar.h"

namespace sinew {

class GraphSolver {
 public:
  GraphSolver(std::vector<Vec3> nodes, std::vector<std::pair<Index, Index>> edges, GraphWeights weights, bool plain);

  std::span<const Vec3> nodes() const { return nodes_; }
  std::span<const std::pair<Index, Index>> edges() const { return edges_; }

  /// Which nodes are fixed and which points are handles. x stays where it is, except that nodes which are fixed, or lie
  /// in a component of the graph without handle or fixed node, go to rest.
  void prepare(const std::vector<bool>& fixed, std::vector<GraphHandle> handles);

  /// Minimises from the present x. `on_iteration` is called after each accepted step; false stops.
  SolveReport solve(std::span<const Vec3> targets, const SolveOptions& options,
                    const std::function<bool()>& on_iteration);

  /// Puts the nodes elsewhere; the edges and x stay. prepare() must follow before the next solve.
  void move_nodes(std::vector<Vec3> nodes);

  const GraphState& x() const { return x_; }
  /// Energy of each node at x (GraphEnergy::node_energy); of a solver that has solved.
  std::vector<double> node_energy() const { return energy_.node_energy(x_); }
  /// Where the next solve starts from, with nothing kept from earlier ones; nodes that do not move then go to rest.
  void set_x(GraphState x);

 private:
  std::vector<bool> moving_nodes(const std::vector<bool>& fixed) const;
  bool same_pattern(const std::vector<bool>& fixed, const std::vector<GraphHandle>& handles) const;
  void rest_what_is_held();
  void turn_x();
  GaussNewtonResult minimise_rigid(const GaussNewtonOptions& options);
  GaussNewtonResult minimise_to_the_end(GaussNewtonOptions options);
  GaussNewtonResult minimise_affine(const GaussNewtonOptions& options);

  std::vector<Vec3> nodes_;
  std::vector<std::pair<Index, Index>> edges_;
  GraphWeights weights_;
  bool plain_;
  std::vector<bool> free_, fixed_;
  std::vector<GraphHandle> handles_;
  GraphEnergy energy_;
  KeptFactor rigid_, affine_;
  std::vector<Vec3> start_nodes_;        ///< when x was set
  bool started_ = true, moved_ = false;  ///< x was set since the last solve, and the nodes moved since then
  bool affine_ready_ = false;            ///< the 12-unknown pattern is analysed: only when it is needed
  std::size_t resting_ = 0;              ///< nodes in components without a constraint
  GraphState x_;
};

}  // namespace sinew
