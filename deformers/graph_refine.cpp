#include "deformers/graph_refine.h"

#include <algorithm>
#include <numeric>

namespace sinew {

namespace {

constexpr Index none = ~Index{0};
constexpr double part = 0.3;   ///< of the energy, that of the marked nodes
constexpr double finer = 0.7;  ///< the radius of a cell's parts: half the area

/// Of each candidate the node that it follows most (the lowest of equal ones).
std::vector<Index> most_followed(const SkinWeights& weights) {
  std::vector<Index> out(weights.size(), none);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    float most = 0;
    for (std::uint64_t e = weights.offsets[i]; e < weights.offsets[i + 1]; ++e)
      if (weights.weights[e] > most || (weights.weights[e] == most && weights.maps[e] < out[i])) {
        most = weights.weights[e];
        out[i] = weights.maps[e];
      }
  }
  return out;
}

/// The candidates of one node, and how far each is from the nodes around it.
struct Cell {
  std::vector<Index> candidates;
  std::vector<double> distance;

  /// Index into `candidates`; the first of equally far ones.
  std::size_t farthest() const {
    return static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin());
  }
};

}  // namespace

std::vector<Index> marked_nodes(std::span<const double> energy) {
  std::vector<Index> order(energy.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return energy[a] > energy[b]; });
  const double wanted = part * std::accumulate(energy.begin(), energy.end(), 0.0);
  double held = 0;
  std::vector<Index> marked;
  for (const Index j : order) {
    if (!(energy[j] > 0) || (held >= wanted && marked.size() * 20 >= energy.size())) break;
    held += energy[j];
    marked.push_back(j);
  }
  return marked;
}

std::vector<Index> candidates_to_add(std::span<const Vec3> candidates, const SkinWeights& weights,
                                     std::span<const Vec3> nodes, std::span<const std::pair<Index, Index>> edges,
                                     std::span<const Index> marked, std::size_t most) {
  std::vector<std::vector<Index>> around(nodes.size());
  for (const auto& [j, k] : edges) {
    around[j].push_back(k);
    around[k].push_back(j);
  }
  std::vector<Cell> cells(nodes.size());
  const std::vector<Index> cell_of = most_followed(weights);
  for (Index i = 0; i < candidates.size(); ++i) {
    if (cell_of[i] == none) continue;
    Cell& cell = cells[cell_of[i]];
    double distance = (candidates[i] - nodes[cell_of[i]]).norm();
    for (const Index k : around[cell_of[i]]) distance = std::min(distance, (candidates[i] - nodes[k]).norm());
    cell.candidates.push_back(i);
    cell.distance.push_back(distance);
  }
  std::vector<double> radius(nodes.size(), 0);  // before anything is added: cells share their corners
  for (const Index j : marked)
    if (!cells[j].candidates.empty()) radius[j] = cells[j].distance[cells[j].farthest()];
  std::vector<Index> added;
  for (const Index j : marked) {
    if (cells[j].candidates.empty()) continue;
    const auto came = [&](Cell& cell, const Vec3& node) {
      for (std::size_t c = 0; c < cell.candidates.size(); ++c)
        cell.distance[c] = std::min(cell.distance[c], (candidates[cell.candidates[c]] - node).norm());
    };
    for (;;) {
      const std::size_t c = cells[j].farthest();
      if (!(cells[j].distance[c] > radius[j] * finer)) break;
      if (added.size() == most) return added;
      const Index i = cells[j].candidates[c];
      added.push_back(i);
      came(cells[j], candidates[i]);
      for (const Index k : around[j]) came(cells[k], candidates[i]);
    }
  }
  return added;
}

}  // namespace sinew
