#include "deformers/sparse_cholesky.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "deformers/small_gemm.h"
#include "deformers/sparse_cholesky_symbolic.h"

namespace sinew {

namespace {

std::size_t round_up(std::size_t n, std::size_t to) {
  return (n + to - 1) / to * to;
}

using Vector = Eigen::Map<Eigen::VectorXd>;
using ConstVector = Eigen::Map<const Eigen::VectorXd>;

}  // namespace

BlockMatrix block_pattern(int block, Index size, std::span<const std::pair<Index, Index>> pairs) {
  std::vector<std::pair<Index, Index>> entries;  // (column, row), row >= column
  entries.reserve(pairs.size() + size);
  for (const auto& [i, j] : pairs) entries.emplace_back(std::min(i, j), std::max(i, j));
  for (Index j = 0; j < size; ++j) entries.emplace_back(j, j);
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());

  BlockMatrix H;
  H.block = block;
  H.offsets.assign(size + 1, 0);
  for (const auto& [column, row] : entries) {
    CHECK(row < size, row, size);
    ++H.offsets[column + 1];
    H.rows.push_back(row);
  }
  for (Index j = 0; j < size; ++j) H.offsets[j + 1] += H.offsets[j];
  H.values.assign(H.rows.size() * H.block_values(), 0.0);
  return H;
}

void multiply(const BlockMatrix& H, std::span<const double> x, std::span<double> out) {
  const Eigen::Index b = H.block;
  CHECK(x.size() == H.size() * static_cast<std::size_t>(b) && out.size() == x.size(), x.size(), out.size(), H.size());
  std::fill(out.begin(), out.end(), 0.0);
  for (Index j = 0; j < H.size(); ++j)
    for (Index e = H.offsets[j]; e < H.offsets[j + 1]; ++e) {
      const Index i = H.rows[e];
      const Eigen::Map<const Eigen::MatrixXd> M(H.at(e), b, b);
      Vector(out.data() + i * b, b) += M * ConstVector(x.data() + j * b, b);
      if (i != j) Vector(out.data() + j * b, b) += M.transpose() * ConstVector(x.data() + i * b, b);
    }
}

void SparseCholesky::analyse(const BlockMatrix& H) {
  factorized_ = false;
  block_ = static_cast<std::size_t>(H.block);
  const Adjacency graph = adjacency_of(H);
  SymbolicFactor symbolic = symbolic_factor(graph, minimum_degree_order(graph), H.block);
  SymbolicFactor dissected = symbolic_factor(graph, nested_dissection_order(graph), H.block);
  if (dissected.flops < symbolic.flops) symbolic = std::move(dissected);
  order_ = std::move(symbolic.order);
  flops_ = symbolic.flops;

  supernodes_.clear();
  supernode_of_.assign(H.size(), 0);
  std::size_t values = 0, largest = 0;
  for (SymbolicFactor::Group& group : symbolic.groups) {
    const std::size_t stride = round_up(group.rows.size() * block_, gemm_lanes);
    for (Index j = 0; j < group.width; ++j) supernode_of_[group.first + j] = static_cast<Index>(supernodes_.size());
    largest = std::max(largest, group.rows.size() * block_);
    supernodes_.push_back({group.first, group.width, std::move(group.rows), values, stride});
    values += stride * group.width * block_;
  }
  panels_.assign(values + gemm_rows, 0.0);  // the last tile of a product reads beyond the last row
  work_.assign(largest, 0.0);
  x_.assign(H.size() * block_, 0.0);
  place_.assign(H.size(), 0);

  std::vector<Index> new_of(H.size());
  for (Index i = 0; i < H.size(); ++i) new_of[order_[i]] = i;
  targets_.resize(H.rows.size());
  for (Index j = 0; j < H.size(); ++j)
    for (Index e = H.offsets[j]; e < H.offsets[j + 1]; ++e) {
      const Index row = new_of[H.rows[e]], column = new_of[j];
      const Supernode& s = supernodes_[supernode_of_[std::min(row, column)]];
      const auto at = std::lower_bound(s.rows.begin(), s.rows.end(), std::max(row, column));
      const auto r = static_cast<std::size_t>(at - s.rows.begin()) * block_;
      const std::size_t c = (std::min(row, column) - s.first) * block_;
      targets_[e] = {s.panel + c * s.stride + r, s.stride, row < column};
    }
}

void SparseCholesky::gather(const BlockMatrix& H, std::span<const double> damping) {
  std::fill(panels_.begin(), panels_.end(), 0.0);
  const auto b = static_cast<Eigen::Index>(block_);
  using Strided = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
  for (std::size_t e = 0; e < targets_.size(); ++e) {
    Strided to(panels_.data() + targets_[e].at, b, b,
               Eigen::OuterStride<>(static_cast<Eigen::Index>(targets_[e].stride)));
    const Eigen::Map<const Eigen::MatrixXd> from(H.at(e), b, b);
    if (targets_[e].transposed)
      to = from.transpose();
    else
      to = from;
  }
  if (damping.empty()) return;
  for (Index j = 0; j < H.size(); ++j) {
    const Target& diagonal = targets_[H.offsets[j]];
    for (std::size_t c = 0; c < block_; ++c)
      panels_[diagonal.at + c * (diagonal.stride + 1)] += damping[j * block_ + c];
  }
}

/// target -= (rows from.. of source) (rows from..to-1 of source)': what the columns of `source` contribute to it.
void SparseCholesky::subtract_update(const Supernode& target, const Supernode& source, std::size_t from,
                                     std::size_t to) {
  const std::size_t m = (source.rows.size() - from) * block_, n = (to - from) * block_, k = source.width * block_;
  const std::size_t stride = round_up(m, gemm_rows);
  if (update_.size() < stride * n) update_.resize(stride * n);
  const double* L = panels_.data() + source.panel + from * block_;
  gemm_abt(m, n, k, L, source.stride, L, source.stride, update_.data(), stride);

  double* panel = panels_.data() + target.panel;
  for (std::size_t first = from; first < source.rows.size();) {
    // Rows that follow each other in both panels are subtracted in one run.
    std::size_t last = first + 1;
    while (last < source.rows.size() && place_[source.rows[last]] == place_[source.rows[last - 1]] + 1) ++last;
    const auto length = static_cast<Eigen::Index>((last - first) * block_);
    const std::size_t row = place_[source.rows[first]] * block_;
    for (std::size_t j = from; j < std::min(to, last); ++j) {
      const std::size_t column = (source.rows[j] - target.first) * block_;
      for (std::size_t c = 0; c < block_; ++c)
        Vector(panel + (column + c) * target.stride + row, length) -=
            ConstVector(update_.data() + ((j - from) * block_ + c) * stride + (first - from) * block_, length);
    }
    first = last;
  }
}

/// Dense Cholesky of the panel: its square top, and the rows below solved with it; gemm_columns columns at a time.
bool SparseCholesky::factorize_panel(const Supernode& s) {
  const std::size_t rows = s.rows.size() * block_, columns = s.width * block_;
  double* panel = panels_.data() + s.panel;
  for (std::size_t first = 0; first < columns; first += gemm_columns) {
    const std::size_t last = std::min(columns, first + gemm_columns), m = rows - first;
    const std::size_t stride = round_up(m, gemm_rows);
    if (first > 0) {
      if (update_.size() < stride * (last - first)) update_.resize(stride * (last - first));
      gemm_abt(m, last - first, first, panel + first, s.stride, panel + first, s.stride, update_.data(), stride);
      for (std::size_t c = first; c < last; ++c)
        Vector(panel + c * s.stride + first, static_cast<Eigen::Index>(m)) -=
            ConstVector(update_.data() + (c - first) * stride, static_cast<Eigen::Index>(m));
    }
    for (std::size_t c = first; c < last; ++c) {
      double* column = panel + c * s.stride;
      const auto length = static_cast<Eigen::Index>(rows - c);
      for (std::size_t l = first; l < c; ++l) {
        const double* earlier = panel + l * s.stride;
        Vector(column + c, length) -= earlier[c] * ConstVector(earlier + c, length);
      }
      const double pivot = column[c];
      if (!(pivot > 0) || !std::isfinite(pivot)) return false;
      Vector(column + c, length) *= 1 / std::sqrt(pivot);
    }
  }
  return true;
}

bool SparseCholesky::factorize(const BlockMatrix& H, std::span<const double> damping) {
  CHECK(H.rows.size() == targets_.size() && static_cast<std::size_t>(H.block) == block_, H.rows.size(), H.block);
  CHECK(damping.empty() || damping.size() == H.size() * block_, damping.size());
  factorized_ = false;
  gather(H, damping);

  // waiting[t]: supernodes whose next rows lie in the columns of t, each with the place of those rows.
  struct Waiting {
    Index supernode;
    std::size_t from;
  };
  std::vector<std::vector<Waiting>> waiting(supernodes_.size());
  for (Index t = 0; t < supernodes_.size(); ++t) {
    const Supernode& target = supernodes_[t];
    for (Index r = 0; r < target.rows.size(); ++r) place_[target.rows[r]] = r;
    for (const Waiting& w : waiting[t]) {
      const Supernode& source = supernodes_[w.supernode];
      std::size_t to = w.from;
      while (to < source.rows.size() && source.rows[to] < target.first + target.width) ++to;
      subtract_update(target, source, w.from, to);
      if (to < source.rows.size()) waiting[supernode_of_[source.rows[to]]].push_back({w.supernode, to});
    }
    if (!factorize_panel(target)) return false;
    if (target.rows.size() > target.width)
      waiting[supernode_of_[target.rows[target.width]]].push_back({t, target.width});
  }
  // A value that is not finite anywhere reaches the pivots below it; a last column alone would not be seen.
  factorized_ = std::all_of(panels_.begin(), panels_.end(), [](double x) { return std::isfinite(x); });
  return factorized_;
}

void SparseCholesky::solve(std::span<double> x) const {
  CHECK(factorized_ && x.size() == x_.size(), x.size(), x_.size());
  const auto b = static_cast<Eigen::Index>(block_);
  for (std::size_t i = 0; i < order_.size(); ++i)
    std::copy_n(x.data() + order_[i] * block_, block_, x_.data() + i * block_);

  using Panel = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
  const auto panel_of = [&](const Supernode& s) {
    return Panel(panels_.data() + s.panel, static_cast<Eigen::Index>(s.rows.size()) * b, s.width * b,
                 Eigen::OuterStride<>(static_cast<Eigen::Index>(s.stride)));
  };
  for (const Supernode& s : supernodes_) {  // L y = P x
    const Panel L = panel_of(s);
    const Eigen::Index columns = L.cols(), below = L.rows() - columns;
    Vector own(x_.data() + s.first * block_, columns), update(work_.data(), below);
    L.topRows(columns).triangularView<Eigen::Lower>().solveInPlace(own);
    update.noalias() = L.bottomRows(below) * own;
    for (std::size_t r = s.width; r < s.rows.size(); ++r)
      Vector(x_.data() + s.rows[r] * block_, b) -= Vector(work_.data() + (r - s.width) * block_, b);
  }
  for (std::size_t i = supernodes_.size(); i-- > 0;) {  // L' z = y
    const Supernode& s = supernodes_[i];
    const Panel L = panel_of(s);
    const Eigen::Index columns = L.cols(), below = L.rows() - columns;
    for (std::size_t r = s.width; r < s.rows.size(); ++r)
      std::copy_n(x_.data() + s.rows[r] * block_, block_, work_.data() + (r - s.width) * block_);
    Vector own(x_.data() + s.first * block_, columns);
    own.noalias() -= L.bottomRows(below).transpose() * Vector(work_.data(), below);
    L.topRows(columns).triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
  for (std::size_t i = 0; i < order_.size(); ++i)
    std::copy_n(x_.data() + i * block_, block_, x.data() + order_[i] * block_);
}

void SparseCholesky::solve_three(std::span<double> x) const {
  CHECK(factorized_ && x.size() == 3 * x_.size(), x.size(), x_.size());
  const std::size_t n = x_.size(), b = block_;
  x3_.resize(3 * n);
  work3_.resize(3 * work_.size());
  double *x0 = x3_.data(), *x1 = x0 + n, *x2 = x1 + n;
  double *w0 = work3_.data(), *w1 = w0 + work_.size(), *w2 = w1 + work_.size();
  for (std::size_t i = 0; i < order_.size(); ++i)
    for (std::size_t r = 0; r < b; ++r)
      for (std::size_t c = 0; c < 3; ++c) x3_[c * n + i * b + r] = x[3 * (order_[i] * b + r) + c];

  for (const Supernode& s : supernodes_) {  // L y = P x
    const std::size_t columns = s.width * b, rows = s.rows.size() * b, first = s.first * b;
    std::fill_n(w0, rows - columns, 0.0);
    std::fill_n(w1, rows - columns, 0.0);
    std::fill_n(w2, rows - columns, 0.0);
    for (std::size_t k = 0; k < columns; ++k) {
      const double* L = panels_.data() + s.panel + k * s.stride;
      double *own0 = x0 + first, *own1 = x1 + first, *own2 = x2 + first;
      const double a0 = own0[k] /= L[k], a1 = own1[k] /= L[k], a2 = own2[k] /= L[k];
      for (std::size_t r = k + 1; r < columns; ++r) {
        own0[r] -= L[r] * a0;
        own1[r] -= L[r] * a1;
        own2[r] -= L[r] * a2;
      }
      const double* below = L + columns;
      for (std::size_t r = 0; r < rows - columns; ++r) {
        w0[r] += below[r] * a0;
        w1[r] += below[r] * a1;
        w2[r] += below[r] * a2;
      }
    }
    for (std::size_t r = s.width; r < s.rows.size(); ++r)
      for (std::size_t i = 0; i < b; ++i) {
        const std::size_t to = s.rows[r] * b + i, from = (r - s.width) * b + i;
        x0[to] -= w0[from];
        x1[to] -= w1[from];
        x2[to] -= w2[from];
      }
  }
  for (std::size_t j = supernodes_.size(); j-- > 0;) {  // L' z = y
    const Supernode& s = supernodes_[j];
    const std::size_t columns = s.width * b, rows = s.rows.size() * b, first = s.first * b;
    for (std::size_t r = s.width; r < s.rows.size(); ++r)
      for (std::size_t i = 0; i < b; ++i) {
        const std::size_t from = s.rows[r] * b + i, to = (r - s.width) * b + i;
        w0[to] = x0[from];
        w1[to] = x1[from];
        w2[to] = x2[from];
      }
    for (std::size_t k = columns; k-- > 0;) {
      const double* L = panels_.data() + s.panel + k * s.stride;
      double *own0 = x0 + first, *own1 = x1 + first, *own2 = x2 + first;
      double a0 = own0[k], a1 = own1[k], a2 = own2[k];
      for (std::size_t r = k + 1; r < columns; ++r) {
        a0 -= L[r] * own0[r];
        a1 -= L[r] * own1[r];
        a2 -= L[r] * own2[r];
      }
      const double* below = L + columns;
      using Run = Eigen::Map<const Eigen::VectorXd>;
      const auto length = static_cast<Eigen::Index>(rows - columns);
      const Run l(below, length);
      a0 -= l.dot(Run(w0, length));
      a1 -= l.dot(Run(w1, length));
      a2 -= l.dot(Run(w2, length));
      own0[k] = a0 / L[k];
      own1[k] = a1 / L[k];
      own2[k] = a2 / L[k];
    }
  }
  for (std::size_t i = 0; i < order_.size(); ++i)
    for (std::size_t r = 0; r < b; ++r)
      for (std::size_t c = 0; c < 3; ++c) x[3 * (order_[i] * b + r) + c] = x3_[c * n + i * b + r];
}

}  // namespace sinew
