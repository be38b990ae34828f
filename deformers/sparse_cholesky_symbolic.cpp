#include "deformers/sparse_cholesky_symbolic.h"

#include <metis.h>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <numeric>

namespace sinew {

namespace {

constexpr Index none = ~Index{0};

Adjacency permuted(const Adjacency& graph, const std::vector<Index>& order) {
  std::vector<Index> place(order.size());
  for (Index i = 0; i < order.size(); ++i) place[order[i]] = i;
  Adjacency out;
  for (const Index old : order) {
    for (const Index j : graph[old]) out.to.push_back(place[j]);
    std::sort(out.to.begin() + static_cast<std::ptrdiff_t>(out.offsets.back()), out.to.end());
    out.offsets.push_back(static_cast<Index>(out.to.size()));
  }
  return out;
}

/// parent[j] of each column in the elimination tree, none for a root [Liu 1990].
std::vector<Index> elimination_tree(const Adjacency& graph) {
  std::vector<Index> parent(graph.size(), none), ancestor(graph.size(), none);
  for (Index j = 0; j < graph.size(); ++j) {
    for (Index i : graph[j]) {
      while (i < j) {
        const Index next = ancestor[i];
        ancestor[i] = j;  // path compression
        if (next == none) parent[i] = j;
        if (next == none || next == j) break;
        i = next;
      }
    }
  }
  return parent;
}

/// Columns so that every subtree is contiguous and children stand before their parent.
std::vector<Index> postorder(const std::vector<Index>& parent) {
  const auto n = static_cast<Index>(parent.size());
  std::vector<Index> child(n + 1, none), sibling(n, none), order, stack;
  for (Index j = n; j-- > 0;) {
    const Index p = parent[j] == none ? n : parent[j];
    sibling[j] = child[p];
    child[p] = j;
  }
  for (Index root = child[n]; root != none; root = sibling[root]) {
    stack.push_back(root);
    while (!stack.empty()) {
      const Index j = stack.back();
      if (child[j] != none) {
        stack.push_back(child[j]);
        child[j] = sibling[child[j]];
      } else {
        order.push_back(j);
        stack.pop_back();
      }
    }
  }
  return order;
}

/// Rows below the diagonal of each column of L.
std::vector<std::vector<Index>> column_structures(const Adjacency& graph, const std::vector<Index>& parent) {
  std::vector<std::vector<Index>> rows(graph.size());
  std::vector<Index> mark(graph.size(), none);
  std::vector<std::vector<Index>> children(graph.size());
  for (Index j = 0; j < graph.size(); ++j) {
    mark[j] = j;
    const auto add = [&](Index i) {
      if (i <= j || mark[i] == j) return;
      mark[i] = j;
      rows[j].push_back(i);
    };
    for (const Index i : graph[j]) add(i);
    for (const Index c : children[j])
      for (const Index i : rows[c]) add(i);
    std::sort(rows[j].begin(), rows[j].end());
    if (parent[j] != none) children[parent[j]].push_back(j);
  }
  return rows;
}

double panel_values(double width, double rows) {
  return width * rows - 0.5 * width * (width - 1);
}

/// Whether a merged panel of `width` columns (scalars) may hold this share of zeros: narrow panels waste more time than
/// zeros do. Bounds found by timing graphs of 200 to 5,000 nodes.
bool worth_merging(double width, double zero_share) {
  if (width <= 24) return zero_share < 0.6;
  if (width <= 72) return zero_share < 0.2;
  return zero_share < 0.06;
}

double flops_of(const SymbolicFactor::Group& group, int block) {
  const double w = group.width * static_cast<double>(block), r = static_cast<double>(group.rows.size()) * block;
  return w * (r - w) * (r - w) + w * w * (r - w) + w * w * w / 3;
}

}  // namespace

Adjacency adjacency_of(const BlockMatrix& H) {
  std::vector<std::vector<Index>> lists(H.size());
  for (Index j = 0; j < H.size(); ++j)
    for (Index e = H.offsets[j]; e < H.offsets[j + 1]; ++e)
      if (const Index i = H.rows[e]; i != j) {
        lists[i].push_back(j);
        lists[j].push_back(i);
      }
  Adjacency out;
  for (std::vector<Index>& list : lists) {
    std::sort(list.begin(), list.end());
    out.to.insert(out.to.end(), list.begin(), list.end());
    out.offsets.push_back(static_cast<Index>(out.to.size()));
  }
  return out;
}

std::vector<Index> minimum_degree_order(const Adjacency& graph) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index j = 0; j < graph.size(); ++j) {
    entries.emplace_back(j, j, 1.0);
    for (const Index i : graph[j]) entries.emplace_back(i, j, 1.0);
  }
  Eigen::SparseMatrix<double> pattern(graph.size(), graph.size());
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(pattern, permutation);
  std::vector<Index> order(graph.size());
  for (Index i = 0; i < graph.size(); ++i) order[i] = static_cast<Index>(permutation.indices()[i]);
  return order;
}

std::vector<Index> nested_dissection_order(const Adjacency& graph) {
  std::vector<Index> order(graph.size());
  std::iota(order.begin(), order.end(), Index{0});
  if (graph.to.empty()) return order;
  auto n = static_cast<idx_t>(graph.size());
  std::vector<idx_t> offsets(graph.offsets.begin(), graph.offsets.end()), to(graph.to.begin(), graph.to.end());
  std::vector<idx_t> permutation(graph.size()), inverse(graph.size());
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;  // the same order every time
  const int status = METIS_NodeND(&n, offsets.data(), to.data(), nullptr, options, permutation.data(), inverse.data());
  if (status == METIS_OK) order.assign(permutation.begin(), permutation.end());
  return order;
}

SymbolicFactor symbolic_factor(const Adjacency& graph, const std::vector<Index>& order, int block) {
  SymbolicFactor out;
  out.order.resize(order.size());
  const std::vector<Index> post = postorder(elimination_tree(permuted(graph, order)));
  for (std::size_t i = 0; i < post.size(); ++i) out.order[i] = order[post[i]];

  const Adjacency ordered = permuted(graph, out.order);
  const std::vector<Index> parent = elimination_tree(ordered);
  std::vector<std::vector<Index>> below = column_structures(ordered, parent);

  for (Index j = 0; j < ordered.size(); ++j) {
    const bool continues = j > 0 && parent[j - 1] == j && below[j - 1].size() == below[j].size() + 1;
    SymbolicFactor::Group group{j, 1, {j}};
    group.rows.insert(group.rows.end(), below[j].begin(), below[j].end());
    // Columns of one structure form a group; then groups that end where this one begins are merged into it while they
    // are its children and few zeros come in.
    while (!out.groups.empty()) {
      const SymbolicFactor::Group& last = out.groups.back();
      const bool child = last.rows.size() > last.width && last.rows[last.width] < group.first + group.width &&
                         last.first + last.width == group.first;
      if (!child) break;
      const double b = block, width = b * (last.width + group.width);
      const double merged = panel_values(width, b * (last.width + static_cast<double>(group.rows.size())));
      const double apart = panel_values(b * last.width, b * static_cast<double>(last.rows.size())) +
                           panel_values(b * group.width, b * static_cast<double>(group.rows.size()));
      const bool same = continues && group.width == 1;
      if (!same && !worth_merging(width, 1 - apart / merged)) break;
      std::vector<Index> rows(last.width);
      std::iota(rows.begin(), rows.end(), last.first);
      rows.insert(rows.end(), group.rows.begin(), group.rows.end());
      group = {last.first, last.width + group.width, std::move(rows)};
      out.groups.pop_back();
    }
    out.groups.push_back(std::move(group));
  }
  for (const SymbolicFactor::Group& group : out.groups) out.flops += flops_of(group, block);
  return out;
}

}  // namespace sinew
