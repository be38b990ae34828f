#include "deformers/graph_influence.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "deformers/graph_weights.h"
#include "deformers/surface_distance.h"

namespace sinew {

namespace {

constexpr std::size_t sample_size = 20000;

void append_row(const SkinWeights& from, std::size_t i, SkinWeights& to) {
  for (std::uint64_t e = from.offsets[i]; e < from.offsets[i + 1]; ++e) {
    to.maps.push_back(from.maps[e]);
    to.weights.push_back(from.weights[e]);
  }
  to.offsets.push_back(to.maps.size());
}

/// The weights of eq. 4 of a vertex that reached a node.
void append_row(const NearestNodes& near, Index vertex, std::vector<double>& w, SkinWeights& to) {
  const std::size_t first = vertex * near.width;
  std::size_t found = 0;
  while (found < near.width && near.node[first + found] != NearestNodes::none) ++found;
  const std::size_t k = std::max<std::size_t>(1, found - 1);
  w[0] = 1;
  if (found > 1) weights_of(&near.distance[first], static_cast<int>(k), w.data());
  for (std::size_t n = 0; n < k; ++n)
    if (w[n] > 0) {
      to.maps.push_back(near.node[first + n]);
      to.weights.push_back(static_cast<float>(w[n]));
    }
  to.offsets.push_back(to.maps.size());
}

std::vector<Vec3> points_of(const NearestTree& tree) {
  return {tree.points().begin(), tree.points().end()};
}

std::string counted(std::size_t n, const std::string& rest) {
  return std::to_string(n) + (n == 1 ? " point " : " points ") + rest;
}

}  // namespace

GraphInfluence::GraphInfluence(std::vector<Vec3> nodes, InfluenceOptions options)
    : options_(std::move(options)), curtains_(options_.cuts), nodes_(nodes), sample_(std::span<const Vec3>{}) {}

std::optional<GraphInfluence::Bound> GraphInfluence::bind_shape(const Shape& shape, std::vector<std::string>& notes,
                                                                const std::function<bool(double)>& progress) {
  return options_.surface ? bind_along_surface(shape, notes, progress) : bind_straight(shape, notes, progress);
}

SkinWeights GraphInfluence::bind(std::span<const Vec3> points, Gradients gradients) const {
  return options_.surface && sample_.size() > 0 ? blended(points) : straight(points, gradients, nullptr, {});
}

SkinWeights GraphInfluence::straight(std::span<const Vec3> points, Gradients gradients, std::size_t* cut_off,
                                     const std::function<bool(double)>& progress) const {
  return node_weights(nodes_, options_.neighbours, points, gradients, progress, curtains_, cut_off);
}

std::optional<GraphInfluence::Bound> GraphInfluence::bind_straight(const Shape& shape, std::vector<std::string>& notes,
                                                                   const std::function<bool(double)>& progress) const {
  std::size_t cut_off = 0;
  Bound bound{straight(shape.positions, Gradients::No, &cut_off, progress), {}};
  if (bound.weights.size() != shape.size()) return std::nullopt;
  if (cut_off > 0)
    notes.push_back(counted(cut_off, "cut off from every node: they follow the nearest one all the same."));
  bound.edges = influence_edges(bound.weights, nodes_.size());
  const double longest = surface_edge_length(shape, nodes_.points());
  if (!has_longer_sides(shape, longest)) return bound;
  const Places places = places_of(shape.positions);
  const std::vector<Vec3> vertices = surface_of(shape, places, longest).vertices;
  const SkinWeights between = straight(std::span(vertices).subspan(places.at.size()), Gradients::No, nullptr, progress);
  if (between.size() != vertices.size() - places.at.size()) return std::nullopt;
  const auto more = influence_edges(between, nodes_.size());
  const auto own = std::move(bound.edges);
  bound.edges.clear();
  std::set_union(own.begin(), own.end(), more.begin(), more.end(), std::back_inserter(bound.edges));
  return bound;
}

std::optional<GraphInfluence::Bound> GraphInfluence::bind_along_surface(const Shape& shape,
                                                                        std::vector<std::string>& notes,
                                                                        const std::function<bool(double)>& progress) {
  const Places places = places_of(shape.positions);
  const std::optional<SkinWeights> rows = surface_rows(shape, places, notes, progress);
  if (!rows) return std::nullopt;
  Bound bound;
  for (const Index v : places.of_point) {
    if (v != Places::none)
      append_row(*rows, v, bound.weights);
    else
      bound.weights.offsets.push_back(bound.weights.maps.size());
  }
  bound.edges = influence_edges(*rows, nodes_.size());
  keep_sample(shape, bound.weights);
  return bound;
}

std::optional<SkinWeights> GraphInfluence::surface_rows(const Shape& shape, const Places& places,
                                                        std::vector<std::string>& notes,
                                                        const std::function<bool(double)>& progress) const {
  const int k = std::max(1, std::min(options_.neighbours, static_cast<int>(nodes_.size()) - 1));
  const NeighbourGraph graph = surface_graph(shape, places, nodes_.points(), k + 1, curtains_);
  if (progress && !progress(0.4)) return std::nullopt;
  const NearestNodes near = nearest_along_surface(graph, nodes_.points(), k + 1, curtains_,
                                                  [&](double done) { return !progress || progress(0.4 + 0.6 * done); });
  if (near.width == 0) return std::nullopt;
  const auto is_lost = [&](Index v) { return near.node[v * near.width] == NearestNodes::none; };
  std::vector<Vec3> lost;
  for (Index v = 0; v < graph.size(); ++v)
    if (is_lost(v)) lost.push_back(graph.vertices[v]);
  const SkinWeights lost_rows = straight(lost, Gradients::No, nullptr, {});
  SkinWeights rows;
  std::vector<double> w(near.width);
  std::size_t lost_before = 0;
  for (Index v = 0; v < graph.size(); ++v) {
    if (is_lost(v))
      append_row(lost_rows, lost_before++, rows);
    else
      append_row(near, v, w, rows);
  }
  if (!lost.empty())
    notes.push_back(counted(lost.size(), "of the surface reach no node along it: they follow by straight distance."));
  return rows;
}

void GraphInfluence::keep_sample(const Shape& shape, const SkinWeights& weights) {
  std::vector<Index> finite;
  for (Index i = 0; i < shape.size(); ++i)
    if (weights.offsets[i] < weights.offsets[i + 1]) finite.push_back(i);
  const std::size_t count = std::min(sample_size, finite.size());
  std::vector<Vec3> points;
  sample_weights_ = {};
  sample_of_shape_.clear();
  for (std::size_t s = 0; s < count; ++s) {
    const Index i = finite[s * finite.size() / count];
    sample_of_shape_.push_back(i);
    points.push_back(shape.positions[i]);
    append_row(weights, i, sample_weights_);
  }
  sample_ = NearestTree(points);
}

SkinWeights GraphInfluence::blended(std::span<const Vec3> points) const {
  // More than five, because some may lie behind a curtain.
  constexpr std::size_t taken = 4;
  const std::size_t width = curtains_.empty() ? taken + 1 : 4 * (taken + 1);
  std::vector<Index> near(points.size() * width);
  std::vector<double> distance(points.size() * width);
  sample_.nearest(points, static_cast<int>(width), near, distance);

  SkinWeights out;
  std::vector<std::pair<double, Index>> row;        // distance, sample point
  std::vector<std::pair<Index, double>> influence;  // node, weight
  for (std::size_t i = 0; i < points.size(); ++i) {
    row.clear();
    for (std::size_t e = i * width; e < (i + 1) * width && row.size() <= taken; ++e)
      if (near[e] != NearestTree::none && !curtains_.part(points[i], sample_.points()[near[e]]))
        row.emplace_back(distance[e], near[e]);
    if (row.empty() && near[i * width] != NearestTree::none) row.emplace_back(0, near[i * width]);
    const double D = row.size() > taken ? row.back().first : std::numeric_limits<double>::infinity();
    if (row.size() > taken) row.pop_back();
    const bool at_a_point = !row.empty() && (row[0].first == 0 || !(row[0].first < D));
    influence.clear();
    for (const auto& [d, s] : row) {
      // The limit where v comes to a point of the shape: that one's row (several at one place have the same).
      if (at_a_point && s != row[0].second) continue;
      const double q = at_a_point ? 1 : (1 - d / D) / d, share = q * q;
      for (std::uint64_t e = sample_weights_.offsets[s]; e < sample_weights_.offsets[s + 1]; ++e)
        influence.emplace_back(sample_weights_.maps[e], share * static_cast<double>(sample_weights_.weights[e]));
    }
    if (!at_a_point) {
      std::stable_sort(influence.begin(), influence.end(),
                       [](const auto& a, const auto& b) { return a.first < b.first; });
    }
    double sum = 0;
    for (const auto& [node, weight] : influence) sum += weight;
    for (std::size_t e = 0; e < influence.size(); ++e) {
      double weight = influence[e].second;
      while (e + 1 < influence.size() && influence[e + 1].first == influence[e].first) weight += influence[++e].second;
      out.maps.push_back(influence[e].first);
      out.weights.push_back(static_cast<float>(at_a_point ? weight : weight / sum));
    }
    out.offsets.push_back(out.maps.size());
  }
  return out;
}

void GraphInfluence::follow(std::vector<Vec3> nodes, const Shape& shape) {
  if (!made_) made_ = std::make_shared<const Made>(Made{options_.cuts, points_of(nodes_), points_of(sample_)});
  // From where all was made, not from the frame before: a frame's answer depends on that frame alone.
  options_.cuts = made_->cuts;
  const NearestTree carriers(made_->nodes);
  for (Cut& cut : options_.cuts)
    for (Vec3& p : cut.path) {
      Index near = 0;
      double distance = 0;
      carriers.nearest({&p, 1}, 1, {&near, 1}, {&distance, 1});
      p += nodes[near] - made_->nodes[near];
    }
  curtains_ = Curtains(options_.cuts);
  nodes_ = NearestTree(nodes);
  std::vector<Vec3> points = made_->sample;
  for (std::size_t s = 0; s < points.size(); ++s)
    if (const Vec3& p = shape.positions[sample_of_shape_[s]]; p.allFinite()) points[s] = p;
  sample_ = NearestTree(points);
}

}  // namespace sinew
