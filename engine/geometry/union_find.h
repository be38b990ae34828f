#pragma once
/// Disjoint sets of 0..n-1 that are joined. The lowest member of a set is its root, so that what is numbered by roots
/// does not depend on the order of joins.

#include <numeric>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew {

class UnionFind {
 public:
  explicit UnionFind(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), Index{0}); }

  Index root(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(Index a, Index b) {
    a = root(a);
    b = root(b);
    if (a < b) parent_[b] = a;
    if (b < a) parent_[a] = b;
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace sinew
