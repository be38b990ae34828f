#pragma once
/// A symmetric positive definite system in some of a mesh's vertices, factorized once and solved for three coordinates.

#include <span>
#include <vector>

#include "deformers/sparse_cholesky.h"

namespace sinew {

class FreeSystem {
 public:
  std::vector<Index> free;  ///< vertices, ascending
  BlockMatrix H;            ///< of blocks of 1, a column for each of `free`

  /// Analyses and factorizes H, which is positive definite but for rounding: where a pivot is not positive, a little of
  /// the diagonal is added, and solve() refines with H as it is. Always gives a factor where H is finite with a
  /// positive diagonal and positive semidefinite.
  void make();

  /// H^-1 b, in the order of `free`. Not from two threads at once.
  std::vector<Vec3> solve(const std::vector<Vec3>& b) const;

  std::size_t factor_values() const { return factor_.factor_values(); }
  double flops() const { return factor_.flops(); }
  double residual() const { return residual_; }  ///< |b - H x| / |b| (greatest) of a known b, after make()

 private:
  std::vector<Vec3> residual_of(std::span<const Vec3> b, std::span<const Vec3> x) const;
  void solve_once(std::vector<Vec3>& x) const;

  SparseCholesky factor_;
  int refinements_ = 0;
  double residual_ = 0;
};

}  // namespace sinew
