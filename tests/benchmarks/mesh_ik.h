#pragma once
/// The original mesh-based inverse kinematics, to compare with: Sumner, Zwicker, Gotsman and Popovic, "Mesh-Based
/// Inverse Kinematics", SIGGRAPH 2005.
///
/// Section 3: the deformation gradient of triangle j in example i, T_ij (3x3), takes the rest triangle and its scaled
/// normal n / sqrt |n| to the example's; T_ij = R_ij S_ij (polar). With weights w_i of the l examples
///   T_j(w) = exp(sum_i w_i log R_ij) sum_i w_i S_ij,
/// and the vertices x are those of least squares, argmin_{x,w} || G x - f(w) ||^2 (section 4), G the matrix that gives
/// the gradients of x, f the stacked T_j(w), x of held vertices given. Gauss-Newton on w and x at once: each step
/// solves [G -J][x; dw] = f(w), J = df/dw, by normal equations. G'G is factorized once; an l x l Schur complement is
/// left for dw.
///
/// Differences: the extra vertex of each triangle that makes its gradient 3x3 is free, so it can be eliminated, and
/// what is left of a gradient are its two columns along the rest triangle: f_j = T_j B_j, B_j (3x2) an orthonormal
/// frame of it. Steps that would raise the energy are halved. As in the paper, w is not bound, the rest shape is an
/// example only where it is given as one, and a logarithm knows no turn above 180 degrees.

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "deformers/sparse_cholesky.h"
#include "engine/geometry/shape.h"

namespace sinew::benchmarks {

class MeshIk {
 public:
  using Triangle = std::array<Index, 3>;

  /// Positions of n vertices at rest and in each of l examples (l at least 1). What hangs together and has no held
  /// vertex goes where the examples' means have it.
  MeshIk(std::vector<Vec3> rest, std::vector<Triangle> triangles, std::vector<std::vector<Vec3>> examples,
         std::vector<Index> held);

  struct Answer {
    std::vector<Vec3> positions;
    std::vector<double> weights;
    int iterations = 0;
    double energy = 0;  ///< || G x - f(w) ||^2
    bool converged = false;
  };
  /// `targets`: one for each held vertex. Starts from equal weights; ends where a step changes no weight by 1e-8.
  Answer solve(std::span<const Vec3> targets, int most_iterations = 100) const;

  /// Without handles: the vertices of given weights, each connected part at the weighted mean of where it is.
  std::vector<Vec3> blend(std::span<const double> weights) const;

  /// f(w): two columns a triangle.
  std::vector<Vec3> features(std::span<const double> weights) const;
  /// df / dw_k.
  std::vector<Vec3> derivative(std::span<const double> weights, std::size_t k) const;

 private:
  /// log R and S of one triangle of one example.
  struct Feature {
    Vec3 turn;
    Mat3 stretch;
  };
  struct Blended {
    Vec3 turn;
    Mat3 R, stretch;
  };
  /// The vertices that are given and the factor of G'G of all others.
  struct System {
    std::vector<Index> given;
    std::vector<Index> place;  ///< among the others; none for a given one
    SparseCholesky factor;
  };

  struct State {
    std::vector<Vec3> x, r;  ///< the vertices that are nearest to f(w), and f(w) - G x
    double energy = 0;
  };

  State state_of(std::span<const Vec3> given, std::span<const double> weights) const;
  Eigen::VectorXd step_of(std::span<const double> weights, std::span<const Vec3> r) const;
  std::unique_ptr<const System> system_of(std::span<const Index> given) const;
  Blended blended(std::size_t triangle, std::span<const double> weights) const;
  /// G'y of the free vertices, and the x of least squares for it.
  std::vector<double> transposed(const System& system, std::span<const Vec3> y) const;
  std::vector<double> solved(const System& system, std::vector<double> right) const;
  std::vector<Vec3> gradients(std::span<const Vec3> x) const;  ///< G x
  /// Given vertices at x, all others zero.
  std::vector<Vec3> only_given(const System& system, std::span<const Vec3> x) const;
  void set_free(const System& system, std::span<const double> values, std::vector<Vec3>& x) const;
  /// Moves the parts of `which` to the weighted means of the examples.
  void place_parts(std::span<const std::uint8_t> which, std::span<const double> weights, std::vector<Vec3>& x) const;

  std::vector<Vec3> rest_;
  std::vector<Triangle> triangles_;
  std::vector<std::vector<Vec3>> examples_;
  std::vector<Index> held_;
  std::vector<Eigen::Matrix<double, 3, 2>> frames_;   ///< B_j
  std::vector<Eigen::Matrix<double, 3, 2>> corners_;  ///< of each triangle: row c times x_c, summed, is its gradient
  std::vector<std::vector<Feature>> features_;        ///< [example][triangle]
  std::vector<Index> part_of_;
  std::vector<std::uint8_t> loose_;            ///< parts without a held vertex
  std::unique_ptr<const System> held_system_;  ///< one vertex of each loose part is given as well
  std::unique_ptr<const System> free_system_;  ///< one vertex of each part is given
};

}  // namespace sinew::benchmarks
