#pragma once
/// The part of a sparse Cholesky factorization that depends only on the pattern: elimination tree, postorder,
/// supernodes.

#include <vector>

#include "deformers/sparse_cholesky.h"

namespace sinew {

/// Neighbours of each block column without itself, ascending (CSR, both triangles).
struct Adjacency {
  std::vector<Index> offsets{0}, to;

  std::span<const Index> operator[](Index i) const { return {to.data() + offsets[i], offsets[i + 1] - offsets[i]}; }
  Index size() const { return static_cast<Index>(offsets.size() - 1); }
};
Adjacency adjacency_of(const BlockMatrix& H);

/// Fill-reducing orders, order[new] = old.
std::vector<Index> minimum_degree_order(const Adjacency& graph);
std::vector<Index> nested_dissection_order(const Adjacency& graph);

struct SymbolicFactor {
  struct Group {
    Index first = 0, width = 0;
    std::vector<Index> rows;  ///< ascending, the group's own columns first
  };
  std::vector<Index> order;   ///< the given order, made a postorder of the elimination tree
  std::vector<Group> groups;  ///< supernodes, ascending
  double flops = 0;           ///< of the dense operations on the groups' panels, for this block size
};

/// Supernodes are merged with their parent where few zeros come in (relaxed supernodes [Ashcraft and Grimes 1989]).
SymbolicFactor symbolic_factor(const Adjacency& graph, const std::vector<Index>& order, int block);

}  // namespace sinew
