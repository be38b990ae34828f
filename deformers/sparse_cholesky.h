#pragma once
/// Sparse Cholesky factorization P H P' = L L' of symmetric positive definite matrices made of equal square blocks:
/// analysed once for a pattern, factorized often. Left-looking over supernodes (groups of columns of like structure,
/// kept as dense panels), so that nearly all work is small dense matrix products [Ng and Peyton 1993].
///
/// Blocks of 6 or 12 (a graph node), 3 (a shell vertex) or 1 (a tet vertex) share this code. One thread.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew {

/// The lower triangle with the diagonal, by block columns: column j has blocks rows[offsets[j]] ..
/// rows[offsets[j+1]-1], ascending, the first of which is j itself. Block e is at values[e * block * block],
/// column-major.
struct BlockMatrix {
  int block = 1;
  std::vector<Index> offsets{0}, rows;
  std::vector<double> values;

  Index size() const { return static_cast<Index>(offsets.size() - 1); }  ///< block columns
  std::size_t block_values() const { return static_cast<std::size_t>(block) * static_cast<std::size_t>(block); }
  double* at(std::size_t e) { return values.data() + e * block_values(); }
  const double* at(std::size_t e) const { return values.data() + e * block_values(); }
};

/// The pattern of a symmetric matrix from pairs (i, j) in any order, diagonal implied; values are zero.
BlockMatrix block_pattern(int block, Index size, std::span<const std::pair<Index, Index>> pairs);

/// out = H x, with both triangles of H. x, out: size * block.
void multiply(const BlockMatrix& H, std::span<const double> x, std::span<double> out);

class SparseCholesky {
 public:
  /// Ordering (the cheaper of minimum degree and nested dissection by flops) and symbolic analysis of H's pattern.
  void analyse(const BlockMatrix& H);

  /// Factorizes H + diag(damping) (damping: size * block, or empty for none), with the pattern that was analysed.
  /// False, and no factor, where a value is not finite or a pivot is not positive: not positive definite to working
  /// precision.
  [[nodiscard]] bool factorize(const BlockMatrix& H, std::span<const double> damping = {});
  bool factorized() const { return factorized_; }
  void forget() { factorized_ = false; }

  /// x <- (H + diag(damping))^-1 x. x: size * block. CHECKs that there is a factor.
  void solve(std::span<double> x) const;

  /// The same for three right-hand sides at a time, number by number side by side: x: size * block * 3. Faster than one
  /// after the other, since what bounds it is reading L.
  void solve_three(std::span<double> x) const;

  std::size_t factor_values() const { return panels_.size(); }  ///< doubles in L's panels
  double flops() const { return flops_; }                       ///< of one factorization

 private:
  struct Supernode {
    Index first = 0, width = 0;  ///< block columns [first, first + width) of the permuted matrix
    std::vector<Index> rows;     ///< block rows of the panel, ascending; the first `width` are the columns themselves
    std::size_t panel = 0;       ///< first value in panels_
    std::size_t stride = 0;      ///< from one column of the panel to the next
  };
  /// Where block e of H goes: its first value in panels_, the panel's stride, and whether it goes there transposed.
  struct Target {
    std::size_t at = 0, stride = 0;
    bool transposed = false;
  };

  void gather(const BlockMatrix& H, std::span<const double> damping);
  void subtract_update(const Supernode& target, const Supernode& source, std::size_t from, std::size_t to);
  [[nodiscard]] bool factorize_panel(const Supernode& s);

  std::size_t block_ = 1;
  std::vector<Index> order_;  ///< order_[new] = old block column
  std::vector<Supernode> supernodes_;
  std::vector<Index> supernode_of_;  ///< of each permuted block column
  std::vector<Target> targets_;
  std::vector<double> panels_, update_;
  std::vector<Index> place_;  ///< row of the panel at work, by permuted block row
  mutable std::vector<double> x_, work_, x3_, work3_;
  double flops_ = 0;
  bool factorized_ = false;
};

}  // namespace sinew
