#pragma once
/// The energy of example-driven discrete shells [Froehlich, Botsch: Example-Driven Deformations Based on Discrete
/// Shells, 2011, sections 3 to 6] with its derivatives (appendix B).
///
///   E(x, alpha) = 1/2 f'f                                                                     (eq. 5, 7)
///   f = ( w_s (l_e - l*_e),  w_b (theta_e - theta*_e),  w_v (v - v*),  w_c (p_c - d_c) )
///   w_s = sqrt(lambda_e) / L_e,  w_b = sqrt(mu_e) L_e / sqrt(A_e),  w_v = sqrt(nu) / V          (eq. 8)
///   l*_e = L_e + sum_i alpha_i (L_e^(i) - L_e), and so theta*_e, v*                            (eq. 6)
///
///   x        vertices, n, in normalised coordinates (bounding-box diagonal 1)
///   alpha    weights of the examples, k
///   l_e, theta_e, v    length and dihedral angle of edge e, volume; capitals: at rest, (i): in example i
///   A_e      area of the two triangles at e
///   p_c      a point that goes with a triangle (ShellTie), d_c where it is to be
///
/// theta - theta* is taken between -pi and pi, so that E has no jump where an angle passes pi. An edge of one triangle
/// or of more than two has no angle, and neither has one beside a triangle without area. An angle that differs by more
/// than pi between rest and an example is a fold that was turned inside out: its mu_e is 0 (section 6.3). v counts only
/// where the surface is closed and consistently oriented.

#include <optional>
#include <span>
#include <vector>

#include "deformers/shell_mesh.h"
#include "deformers/sparse_cholesky.h"

namespace sinew {

/// An edge x[0] x[1] and the third corners x[2], x[3] of the triangles at it; none: it has no angle.
struct ShellEdge {
  static constexpr Index none = ~Index{0};
  std::array<Index, 4> x{};
  bool hinge() const { return x[2] != none; }
};

/// Each edge of the triangles once.
std::vector<ShellEdge> shell_edges(std::span<const Triangle> triangles);

/// The dihedral angle of x1 x2, between x3 and x4, 0 where flat, -pi..pi, and its gradient by each of them (appendix
/// B). `least`: what twice the area of each triangle, x1 x2 x3 and x1 x2 x4, is taken for where it is smaller: the
/// gradient grows without bound as a triangle loses its area, where the angle jumps, and one such triangle would let
/// the whole surface make no more than tiny steps. Zero gradients where a triangle has no area and there is no least.
struct Hinge {
  double theta = 0;
  std::array<Vec3, 4> gradient{};
};
Hinge hinge_at(const Vec3& x1, const Vec3& x2, const Vec3& x3, const Vec3& x4, std::array<double, 2> least = {0, 0});
double dihedral_angle(const Vec3& x1, const Vec3& x2, const Vec3& x3, const Vec3& x4);

/// 1/6 of the sum of x_i x x_j . x_k over triangles (eq. 4).
double volume_of(std::span<const Vec3> x, std::span<const Triangle> triangles);

/// A point at `weights` in a triangle and `height` above it along the unit normal.
struct ShellTie {
  Triangle corners{};
  Vec3 weights = Vec3::Zero();  ///< sum to 1
  double height = 0;

  Vec3 at(std::span<const Vec3> x) const;
  /// Derivatives of at() by each corner.
  std::array<Mat3, 3> derivative(std::span<const Vec3> x) const;
  bool operator==(const ShellTie&) const = default;
};

struct ShellStiffness {
  double lambda = 100, mu = 1, nu = 1000;  ///< of stretching, bending, volume
  bool learned = false;                    ///< lambda_e, mu_e less where examples stretch and bend more (appendix A)
};

class ShellEnergy {
 public:
  struct Terms {
    double stretch = 0, bend = 0, volume = 0, tie = 0;
    double total() const { return stretch + bend + volume + tie; }
  };

  /// Poses: at rest, then the examples. With a `source` these are poses of that: an edge changes by as large a share of
  /// its length, and by as much of its angle, as there (deformation transfer).
  ShellEnergy(std::span<const std::vector<Vec3>> poses, std::span<const Triangle> triangles, ShellStiffness stiffness,
              std::span<const Vec3> source = {});

  std::size_t examples() const { return lengths_.size() - 1; }
  const std::vector<ShellEdge>& edges() const { return edges_; }
  bool keeps_volume() const { return w_v_ > 0; }
  std::size_t folds() const { return folds_; }  ///< edges without mu_e because an example turns them inside out

  /// Which vertices are unknowns and in what order; edges that depend on none of them are left out of E. `factors`:
  /// how many times as stiff the material is at each vertex; empty: as it is.
  void set_unknowns(std::vector<Index> number, Index count, std::span<const double> factors);
  void set_ties(std::vector<ShellTie> ties) { ties_ = std::move(ties); }
  void set_targets(std::vector<Vec3> targets) { targets_ = std::move(targets); }  ///< d, one a tie
  void set_weights(std::span<const double> alpha);                                ///< l*, theta*, v* of eq. 6

  Terms energy(std::span<const Vec3> x) const;
  /// J'f by the unknowns (3 count numbers), and by alpha (k numbers).
  void gradient(std::span<const Vec3> x, std::span<double> by_x, std::span<double> by_alpha) const;

  /// J'J of eq. 9 without the volume's row: A by the unknowns, B between them and alpha (column by column), C by alpha
  /// (k x k); and that row u, by the unknowns and then alpha (section 6.2).
  struct Normal {
    std::vector<double> B, C, u;
  };
  BlockMatrix pattern();
  void hessian(std::span<const Vec3> x, BlockMatrix& A, Normal& rest) const;

  /// J'J d by the unknowns and then alpha, d a displacement of all vertices, alpha and ties' targets as they are.
  std::vector<double> response(std::span<const Vec3> x, std::span<const Vec3> d) const;

  /// Weights that make E least for this x; `pinned` ones stay. E is quadratic in alpha.
  std::vector<double> best_weights(std::span<const Vec3> x, std::span<const std::optional<double>> pinned) const;

  /// Triangles with less than least_area of their area: there E has steps, and a minimum among them is not smooth.
  std::size_t collapsed(std::span<const Vec3> x) const;

  /// What of E belongs to each vertex: halves of its edges'.
  std::vector<double> vertex_energies(std::span<const Vec3> x) const;

  static constexpr double w_c = 3e3;  ///< of ties
  /// Of the least area that it has in a pose: below this share a triangle counts as so large in the gradient of its
  /// angles.
  static constexpr double least_area = 0.3;

 private:
  /// An edge that depends on an unknown, with where its blocks of A are.
  struct Active {
    Index edge = 0;
    double w_s = 0, w_b = 0, length = 0, angle = 0;  ///< length, angle: l*, theta*
    std::array<std::size_t, 10> slots{};             ///< of the lower triangle of its 4 x 4 blocks; no_slot where none
  };
  static constexpr std::size_t no_slot = ~std::size_t{0};

  void measure(std::span<const Vec3> pose, std::vector<double>& lengths, std::vector<double>& angles) const;
  void weigh(std::span<const std::vector<Vec3>> poses, ShellStiffness stiffness);
  void learn();
  /// A row of J with its residual: gradients by the corners of `edge`, and by each alpha -w times the change there.
  struct Row {
    const Active& edge;
    std::span<const Vec3> gradients;
    double residual, w;
    const std::vector<std::vector<double>>& changes;
  };
  template <class Visit>
  void each_row(std::span<const Vec3> x, const Visit& visit) const;
  double stretch(const Active& a, std::span<const Vec3> x) const;
  std::vector<Vec3> volume_gradient(std::span<const Vec3> x) const;
  double volume_residual(std::span<const Vec3> x) const;

  std::vector<Triangle> triangles_;
  std::vector<double> areas_;  ///< twice the least, over all poses
  std::vector<ShellEdge> edges_;
  std::vector<std::vector<double>> lengths_, angles_;  ///< at rest; then each example's difference from that
  std::vector<double> volumes_;                        ///< likewise
  std::vector<std::array<double, 2>> least_;           ///< of an edge's two triangles: see hinge_at
  std::vector<double> w_s_, w_b_;                      ///< as the material is; w_b is 0 where there is no angle
  double w_v_ = 0;
  std::size_t folds_ = 0;

  std::vector<Index> number_;  ///< of each vertex among the unknowns; ShellEdge::none
  Index count_ = 0;
  std::vector<Active> active_;
  std::vector<ShellTie> ties_;
  std::vector<std::array<std::size_t, 6>> tie_slots_;
  std::vector<Vec3> targets_;
  double volume_target_ = 0;
  std::vector<double> alpha_;
};

}  // namespace sinew
