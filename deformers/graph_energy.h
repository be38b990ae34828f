#pragma once
/// The energy of a deformation graph and its derivatives [Sumner, Schmid, Pauly 2007, eq. 5-9], in normalised
/// coordinates (bounding-box diagonal 1: E_rot has no unit and the other terms are squared lengths, so the weights need
/// a fixed length).
///
///   E = w_rot sum_j Rot(R_j)                                                              eq. 5, 6
///     + w_reg sum_j sum_{k in N(j)} |R_j (g_k - g_j) + g_j + t_j - (g_k + t_k)|^2         eq. 7, alpha_jk = 1
///     + w_con sum_l |v'_l - q_l|^2,   v' by eq. 2                                         eq. 8
///
///   m       nodes, at g_j; R_j (3x3) and t_j their maps: p -> R_j (p - g_j) + g_j + t_j   eq. 1
///   N(j)    nodes that share an edge with j, each edge counted from both ends
///   v_l,q_l handle point l and its target
///
/// The terms of eq. 7 and 8 are rows r = sum_j (R_j - I) beta_j + b_j t_j - rhs, the same for x, y and z. Hence
/// J'J = A (x) I3 + 9x9 blocks of E_rot, where A = sum_rows (beta, b)(beta, b)' is 4m-by-4m and does not change while
/// handles are dragged. A step is taken in each node's own frame Q_j, a rotation near R_j:
///
///   rigid  (6 a node):  R_j <- R_j exp(omega_j), t_j <- t_j + R_j tau_j          E_rot is zero where R_j are rotations
///   affine (12 a node): R_j <- R_j + Q_j Delta_j, t_j <- t_j + Q_j tau_j         the paper's unknowns, rotated
///
/// so that a Hessian depends on relative rotations Q_i' Q_j only, and an old factor stays good while parts turn as a
/// whole.

#include <span>
#include <vector>

#include "deformers/sparse_cholesky.h"

namespace sinew {

struct GraphWeights {
  double rotation = 1, regularization = 10, constraint = 100;  ///< w_rot, w_reg, w_con: the paper's
  /// Of a chain of nodes, whose edges alone leave its twist undetermined where it is straight: eq. 7 is asked as well
  /// of the six points at an edge's length l around the node, R_j (g_k + l e - g_j) + g_j + t_j = g_k + t_k + R_k l e,
  /// with this share of the weight each.
  double around = 0;
};

/// x: R_j and t_j of all m nodes. Fixed nodes have R = I, t = 0.
struct GraphState {
  std::vector<Mat3> R;
  std::vector<Vec3> t;

  static GraphState rest(std::size_t nodes) {
    return {std::vector<Mat3>(nodes, Mat3::Identity()), std::vector<Vec3>(nodes, Vec3::Zero())};
  }
};

/// A point v with its influences, that is to be at a target (normalised coordinates).
struct GraphHandle {
  Vec3 v = Vec3::Zero();
  std::vector<Index> nodes;
  std::vector<double> weights;
};

class GraphEnergy {
 public:
  /// Rows and A for these nodes, edges and handle points. Nodes that are not free keep the identity: their unknowns are
  /// dropped [section 4, fixed constraints].
  void build(std::span<const Vec3> nodes, std::span<const std::pair<Index, Index>> edges, const std::vector<bool>& free,
             std::span<const GraphHandle> handles, const GraphWeights& weights);

  /// The same nodes and handle points elsewhere: what build() was told otherwise stays. Targets must be set anew.
  void move(std::span<const Vec3> nodes, std::span<const GraphHandle> handles);

  /// Where the handle points are to be: q_l, in the order of the handles.
  void set_targets(std::span<const Vec3> targets);

  std::size_t free_count() const { return free_nodes_.size(); }
  std::span<const Index> free_nodes() const { return free_nodes_; }  ///< node of each unknown block, ascending

  struct Terms {
    double rotation = 0, regularization = 0, constraint = 0;  ///< weighted
    double total() const { return rotation + regularization + constraint; }
  };
  /// With the rotation term, unless `rigid` (then R_j are rotations and it is zero but for rounding).
  Terms energy(const GraphState& x, bool rigid) const;

  /// The same by node (all m, of those that rest 0): E_rot is the node's own, a row of the other terms is shared evenly
  /// by the free nodes it has.
  std::vector<double> node_energy(const GraphState& x) const;

  /// J'f in the frames Q (half the gradient): 6 or 12 values for each free node, [omega, tau] or [Delta by columns,
  /// tau].
  void gradient_rigid(const GraphState& x, std::span<double> out) const;
  void gradient_affine(const GraphState& x, const std::vector<Mat3>& Q, std::span<double> out) const;

  /// A vector of three padded to four, and [R - I | t] with a row of zeros: whole registers.
  using Vec4 = Eigen::Vector4d;
  using Mat4 = Eigen::Matrix4d;
  /// sum_rows r [beta, b]' of each free node, for both linear terms: half their gradient by [R_j | t_j].
  std::vector<Mat4> linear_gradient(const GraphState& x) const;
  /// The block of A that belongs to the i-th free node.
  Eigen::Map<const Mat4> A_of(std::size_t i) const { return Eigen::Map<const Mat4>(A_.at(A_.offsets[i])); }
  const GraphWeights& weights() const { return weights_; }

  /// J'J in the frames Q. Pattern: hessian_pattern(6 or 12).
  BlockMatrix hessian_pattern(int block) const;
  /// For rigid steps at R_j = Q_j U_j (graph_polar.h), U_j beside x.R = Q_j of the free nodes; empty: the identity.
  void hessian_rigid(const GraphState& x, BlockMatrix& H, std::span<const Mat3> U = {}) const;
  void hessian_affine(const GraphState& x, const std::vector<Mat3>& Q, BlockMatrix& H) const;

  /// x + scale * step.
  GraphState step_rigid(const GraphState& x, std::span<const double> step, double scale) const;
  GraphState step_affine(const GraphState& x, const std::vector<Mat3>& Q, std::span<const double> step,
                         double scale) const;

  /// Distances of handle points from their targets (normalised): rms and largest; zero without handles.
  std::pair<double, double> handle_error(const GraphState& x) const;

 private:
  /// One node of a row: node (all m) and [beta, b], times the square root of the term's weight.
  struct Entry {
    Index node;
    Vec4 coefficients;
  };

  void build_A();
  static std::vector<Mat4> displacements(const GraphState& x);
  Vec4 residual(const std::vector<Mat4>& D, std::size_t row) const;

  GraphWeights weights_;
  std::vector<Index> free_nodes_;
  std::vector<Index> unknown_of_;         ///< of each node, or none
  std::vector<std::size_t> row_offsets_;  ///< rows of eq. 7, then of eq. 8
  std::vector<Entry> entries_;
  std::vector<std::pair<Index, Index>> directed_;  ///< (j, k) of each row of eq. 7, without those around
  std::vector<Index> places_;                      ///< block of A that each product of two entries of a row goes to
  std::vector<Vec3> handle_points_;                ///< v_l
  std::vector<Vec4> rhs_;                          ///< sqrt(w_con) (q_l - v_l)
  std::size_t regularization_rows_ = 0;
  std::size_t edge_rows_ = 0;  ///< rows of eq. 7 that have t_k alone of node k: all, but for those around
  double sqrt_reg_ = 0;
  BlockMatrix A_;
};

/// exp of the cross-product matrix of w, an exact rotation to rounding.
Mat3 rotation_of(const Vec3& w);

}  // namespace sinew
