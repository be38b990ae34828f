#include "deformers/graph_weights.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "engine/geometry/parallel.h"

namespace sinew {

namespace {

constexpr std::size_t block = 65536;

/// Derivatives of the weights that weights_of gives, by the point v; `near` are its k + 1 nearest nodes. With
/// s_j = 1 - d_j / d_max and q_j = s_j^2: grad w_j = (grad q_j - w_j sum grad q) / sum q.
void gradients_of(const Eigen::Vector3d& v, std::span<const Eigen::Vector3d> nodes, const std::uint32_t* near,
                  const double* distance, int k, const double* w, Eigen::Vector3d* out) {
  const auto direction = [&](int i) {
    return distance[i] > 0 ? Eigen::Vector3d((v - nodes[near[i]]) / distance[i]) : Eigen::Vector3d::Zero();
  };
  const double d_max = distance[k];
  const Eigen::Vector3d grad_max = direction(k);
  Eigen::Vector3d sum_grad = Eigen::Vector3d::Zero();
  double sum = 0;
  for (int i = 0; i < k; ++i) {
    out[i].setZero();
    if (!(w[i] > 0 && d_max > 0)) continue;
    const double s = 1 - distance[i] / d_max;
    out[i] = 2 * s / d_max * (grad_max * (distance[i] / d_max) - direction(i));
    sum_grad += out[i];
    sum += s * s;
  }
  for (int i = 0; i < k; ++i)
    if (sum > 0 && w[i] > 0) out[i] = (out[i] - w[i] * sum_grad) / sum;
}

/// The nearest nodes of v that no curtain parts from it, at most `width`: as few of all nodes are asked for as will do.
/// Returns how many; none where all are cut off.
std::size_t nearest_uncut(const NearestTree& nodes, const Eigen::Vector3d& v, std::size_t width,
                          const Curtains& curtains, std::uint32_t* near, double* distance) {
  for (std::size_t asked = 2 * width;; asked *= 2) {
    asked = std::min(asked, nodes.size());
    std::vector<std::uint32_t> index(asked);
    std::vector<double> far(asked);
    nodes.nearest({&v, 1}, static_cast<int>(asked), index, far);
    std::size_t found = 0;
    for (std::size_t i = 0; i < asked && found < width; ++i) {
      if (curtains.part(v, nodes.points()[index[i]])) continue;
      near[found] = index[i];
      distance[found++] = far[i];
    }
    if (found == width || asked == nodes.size()) return found;
  }
}

}  // namespace

void weights_of(const double* distance, int k, double* w) {
  // A node as far as d_max but for rounding has no influence: which of several such nodes is the k-th is an accident,
  // and must not make an edge.
  constexpr double rounding = 1e-9;
  const double d_max = distance[k];
  double sum = 0;
  for (int i = 0; i < k; ++i) {
    const double s = d_max > 0 ? 1 - distance[i] / d_max : 0;
    w[i] = s > rounding ? s * s : 0;
    sum += w[i];
  }
  for (int i = 0; i < k; ++i) w[i] = sum > 0 ? w[i] / sum : 1.0 / k;
}

SkinWeights node_weights(const NearestTree& nodes, int k, std::span<const Eigen::Vector3d> points, Gradients gradients,
                         const std::function<bool(double)>& progress, const Curtains& curtains, std::size_t* cut_off) {
  CHECK(k >= 1, k);
  SkinWeights out;
  const auto m = static_cast<int>(nodes.size());
  if (m == 0) {
    out.offsets.assign(points.size() + 1, 0);
    return out;
  }
  k = std::max(1, std::min(k, m - 1));
  const auto width = static_cast<std::size_t>(std::min(k + 1, m));
  out.offsets.reserve(points.size() + 1);
  out.maps.reserve(points.size() * static_cast<std::size_t>(k));
  out.weights.reserve(points.size() * static_cast<std::size_t>(k));
  std::vector<std::uint32_t> index(block * width);
  std::vector<double> distance(block * width), w(width);
  std::vector<Eigen::Vector3d> slopes(width, Eigen::Vector3d::Zero());
  for (std::size_t first = 0; first < points.size(); first += block) {
    if (progress && !progress(static_cast<double>(first) / static_cast<double>(points.size()))) return {};
    const std::size_t count = std::min(block, points.size() - first);
    nodes.nearest(points.subspan(first, count), static_cast<int>(width), {index.data(), count * width},
                  {distance.data(), count * width});
    for (std::size_t i = 0; i < count; ++i) {
      std::uint32_t* near = &index[i * width];
      double* far = &distance[i * width];
      const Eigen::Vector3d& v = points[first + i];
      if (near[0] != NearestTree::none) {
        std::size_t found = width;
        const auto cut = [&](std::uint32_t j) { return curtains.part(v, nodes.points()[j]); };
        if (!curtains.empty() && std::any_of(near, near + width, cut)) {
          found = nearest_uncut(nodes, v, width, curtains, near, far);
          if (found == 0 && cut_off != nullptr) ++*cut_off;
        }
        // With one node its weight is 1: none at all is far enough to be d_max.
        const int influences = found > 1 ? static_cast<int>(found) - 1 : 1;
        if (found > 1)
          weights_of(far, influences, w.data());
        else
          w[0] = 1;
        std::fill(slopes.begin(), slopes.end(), Eigen::Vector3d::Zero());
        if (gradients == Gradients::Yes && found > 1)
          gradients_of(v, nodes.points(), near, far, influences, w.data(), slopes.data());
        for (std::size_t n = 0; n < static_cast<std::size_t>(influences); ++n)
          if (w[n] > 0) {
            out.maps.push_back(near[n]);
            out.weights.push_back(static_cast<float>(w[n]));
            if (gradients == Gradients::Yes) out.gradients.push_back(slopes[n].cast<float>());
          }
      }
      out.offsets.push_back(out.maps.size());
    }
  }
  return out;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> influence_edges(const SkinWeights& weights, std::size_t nodes) {
  // A bit a pair while that is small, a hash set otherwise: most points repeat the pairs of their neighbours.
  constexpr std::size_t dense_limit = 16384;
  std::vector<bool> seen(nodes <= dense_limit ? nodes * nodes : 0, false);
  std::unordered_set<std::uint64_t> sparse;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t i = 0; i < weights.size(); ++i)
    for (std::uint64_t a = weights.offsets[i]; a < weights.offsets[i + 1]; ++a)
      for (std::uint64_t b = a + 1; b < weights.offsets[i + 1]; ++b) {
        const auto [low, high] = std::minmax(weights.maps[a], weights.maps[b]);
        const std::uint64_t key = low * static_cast<std::uint64_t>(nodes) + high;
        if (seen.empty() ? !sparse.insert(key).second : static_cast<bool>(seen[key])) continue;
        if (!seen.empty()) seen[key] = true;
        edges.emplace_back(low, high);
      }
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace sinew
