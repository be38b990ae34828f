#pragma once
/// The energy of a solid cut into tets [Stoll, de Aguiar, Theobalt, Seidel 2007, sections 2.2 and 2.3], its Laplacian,
/// and its gradient.
///
///   E(x) = sum_j w_j |T_j(x) - R_j|^2 + sum_i k |C_i x - d_i|^2
///
///   x     vertices, n x 3, in normalised coordinates (bounding-box diagonal 1)
///   G_j   gradients of the shape functions of tet j, 3 x 4 (eq. 2.3)
///   T_j   = (G_j x)', the map of tet j, acting on columns (eq. 2.6)
///   R_j   the rotation nearest to T_j (eq. 2.7); of a rigid group, one nearest to all of its T_j
///   w_j   volume of tet j, times the square of its stiffness: gradients scaled by a factor (section 2.3.2)
///   C_i   a point as a combination of vertices, d_i where it is to be, k the weight of such a tie
///
/// The report alternates L x = delta (eq. 2.1) and R = polar(T) (eq. 2.7). That is block descent on E: for given R_j, E
/// is least where L x = G'D R, and for given x where R_j is the polar factor. By the second, dE/dx = 2 (L x - G'D R(x))
/// holds although R depends on x.

#include <array>
#include <span>
#include <vector>

#include "deformers/rotation_lanes.h"
#include "deformers/sparse_cholesky.h"
#include "engine/geometry/shape.h"

namespace sinew {

/// A point as a combination of up to four vertices, for use with tie_weight.
struct TetTie {
  std::array<Index, 4> vertices{};
  std::array<double, 4> weights{};  ///< sum to 1

  Vec3 at(std::span<const Vec3> x) const {
    Vec3 p = Vec3::Zero();
    for (std::size_t a = 0; a < 4; ++a) p += weights[a] * x[vertices[a]];
    return p;
  }
};

class TetEnergy {
 public:
  static constexpr double tie_weight = 1e3;  ///< k, in units of the largest diagonal of L

  /// Tets of positive volume, in normalised coordinates.
  TetEnergy(std::span<const Vec3> vertices, std::span<const Tet> tets);

  std::size_t vertices() const { return vertex_count_; }
  std::size_t tets() const { return tet_count_; }

  /// Factors of gradients, one a tet (1: as it is), all above 0.
  void set_stiffness(std::span<const double> factors);
  /// Tets that turn as one; a tet is in one group at most.
  void set_groups(std::vector<std::vector<Index>> groups);
  void set_ties(std::vector<TetTie> ties);
  void set_targets(std::vector<Vec3> targets);  ///< d, one a tie

  /// L over the vertices with number[v] != none, in the order of these numbers 0..count-1; with ties, L + k C'C.
  static constexpr Index none = ~Index{0};
  enum class Ties { No, Yes };
  BlockMatrix laplacian(std::span<const Index> number, Index count, Ties ties) const;
  /// L of all vertices.
  BlockMatrix laplacian() const;

  enum class Rotations { Nearest, Kept };
  /// E(x) with R_j nearest to T_j(x), or as they are; half_gradient <- (dE/dx) / 2, n rows.
  double evaluate(std::span<const Vec3> x, Rotations rotations, std::span<Vec3> half_gradient);
  /// The part of E that belongs to the ties, at the last x.
  double tie_energy() const { return tie_energy_; }

  Mat3 rotation(Index tet) const;
  void set_rotation(Index tet, const Mat3& R);
  Mat3 map(Index tet, std::span<const Vec3> x) const;  ///< T_j
  /// All of them, tets() many; the last bits may be others.
  void maps(std::span<const Vec3> x, std::span<Mat3> out) const;
  /// w_j |T_j - R_j|^2 of each tet at the last x.
  std::vector<double> tet_energies() const;

 private:
  /// lane_count tets side by side; lanes beyond the last tet have weight 0.
  struct Block {
    std::array<Lanes, 9> g{};  ///< gradients of shape functions 0..2; of the last: minus their sum
    Lanes volume{}, w{};
    Mat3Lanes R{};
    std::array<std::array<Index, lane_count>, 4> v{};
  };
  Mat3Lanes maps(const Block& block, std::span<const Vec3> x) const;
  void turn_groups(std::span<const Vec3> x);
  double evaluate_block(std::size_t b, std::span<const Vec3> x, Rotations rotations);
  double add_ties(std::span<const Vec3> x, std::span<Vec3> half_gradient);
  Eigen::Matrix<double, 3, 4> gradients(Index tet) const;

  std::size_t vertex_count_ = 0, tet_count_ = 0;
  std::vector<Block> blocks_;
  std::vector<std::vector<Index>> groups_;
  std::vector<Index> group_of_;  ///< of each lane of each block; none: its own
  std::vector<Mat3> group_rotations_;
  std::vector<TetTie> ties_;
  std::vector<Vec3> targets_;
  double largest_diagonal_ = 0, tie_energy_ = 0;
  std::vector<double> energies_;       ///< of each block
  std::vector<Lanes> tet_energies_;    ///< of each block's lanes
  std::vector<double> forces_;         ///< w (T - R) g of each block's corners
  std::vector<std::size_t> incident_;  ///< of each vertex, places in forces_ ...
  std::vector<std::size_t> first_{0};  ///< ... from first_[v] to first_[v + 1]
};

}  // namespace sinew
