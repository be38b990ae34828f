#include "deformers/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

#include "engine/geometry/bounds.h"
#include "engine/geometry/nearest.h"
#include "engine/geometry/part_gaps.h"

namespace sinew {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Median distance of a node to the next one at another place.
double node_spacing(std::span<const Vec3> nodes) {
  constexpr std::size_t k = 4;
  std::vector<Index> near(nodes.size() * k);
  std::vector<double> distance(nodes.size() * k), gaps;
  NearestTree(nodes).nearest(nodes, static_cast<int>(k), near, distance);
  for (std::size_t j = 0; j < nodes.size(); ++j)
    for (std::size_t i = 0; i < k; ++i)
      if (const double d = distance[j * k + i]; d > 0 && std::isfinite(d)) {
        gaps.push_back(d);
        break;
      }
  return median(std::move(gaps));
}

Edges bridges_of(const Surface& surface, const GraphParts& parts, std::span<const Vec3> nodes, double spacing,
                 int enough, const Curtains& curtains) {
  constexpr double rounding = 1e-5;  // of the diagonal: seams of files with five digits
  std::vector<Index> near(nodes.size()), weight(parts.count, 0);
  std::vector<double> distance(nodes.size()), lengths;
  NearestTree(surface.vertices).nearest(nodes, 1, near, distance);
  for (const Index v : near) ++weight[parts.of_vertex[v]];
  lengths.reserve(surface.edges.size());
  for (const auto& [a, b] : surface.edges) lengths.push_back((surface.vertices[a] - surface.vertices[b]).norm());
  BridgeWishes wishes;
  wishes.touch = rounding * bounds_of(surface.vertices).diagonal();
  wishes.reach = spacing;
  wishes.spacing = median(std::move(lengths));
  wishes.weight = weight;
  wishes.enough = static_cast<Index>(enough);
  return bridges_between(surface.vertices, parts, wishes, curtains);
}

/// A point reached from a node; the queue gives the nearest first, of equally near ones the lowest node and point.
struct Label {
  double distance;
  Index node, vertex;
  bool operator<(const Label& other) const {
    if (distance != other.distance) return distance > other.distance;
    return std::tie(node, vertex) > std::tie(other.node, other.vertex);
  }
};

class Sweep {
 public:
  Sweep(const NeighbourGraph& graph, std::span<const Vec3> nodes, std::size_t width, const Curtains& curtains)
      : graph_(graph), nodes_(nodes), curtains_(curtains), width_(width) {
    out_.width = width;
    out_.node.assign(graph.size() * width, NearestNodes::none);
    out_.distance.assign(graph.size() * width, infinite);
    settled_.assign(graph.size() * width, 0);
    done_.assign(graph.size(), 0);
  }

  NearestNodes run(const std::function<bool(double)>& progress) {
    start();
    const std::size_t all = graph_.size() * width_;
    for (std::size_t settled = 0; !queue_.empty();) {
      const Label label = queue_.top();
      queue_.pop();
      const std::size_t entry = entry_of(label.vertex, label.node);
      // A better way came later, or as many nodes are nearer.
      if (entry == absent || settled_[entry] != 0 || out_.distance[entry] != label.distance) continue;
      settled_[entry] = 1;
      ++done_[label.vertex];
      spread(label);
      if (++settled % 65536 == 0 && progress && !progress(static_cast<double>(settled) / static_cast<double>(all)))
        return {};
    }
    sort_rows();
    return std::move(out_);
  }

 private:
  static constexpr std::size_t absent = ~std::size_t{0};

  std::size_t entry_of(Index vertex, Index node) const {
    const std::size_t first = vertex * width_;
    for (std::size_t e = first; e < first + width_; ++e)
      if (out_.node[e] == node) return e;
    return absent;
  }

  /// Each node at its nearest vertex and at that one's neighbours. Of the nearest few vertices, the first that no
  /// curtain parts from it.
  void start() {
    constexpr std::size_t k = 8;
    std::vector<Index> near(nodes_.size() * k);
    std::vector<double> distance(nodes_.size() * k);
    NearestTree(graph_.vertices).nearest(nodes_, static_cast<int>(k), near, distance);
    for (Index j = 0; j < nodes_.size(); ++j) {
      const auto row = std::span(near).subspan(j * k, k);
      const auto free = [&](Index v) {
        return v != NearestNodes::none && !curtains_.part(nodes_[j], graph_.vertices[v]);
      };
      const auto found = curtains_.empty() ? row.begin() : std::find_if(row.begin(), row.end(), free);
      if (found == row.end() || *found == NearestNodes::none) continue;
      offer(*found, j, (nodes_[j] - graph_.vertices[*found]).norm());
      for (const Index v : graph_[*found])
        if (curtains_.empty() || free(v)) offer(v, j, (nodes_[j] - graph_.vertices[v]).norm());
    }
  }

  /// Takes a way to a vertex where it is shorter than the one known, or among the `width` nearest.
  void offer(Index vertex, Index node, double distance) {
    const std::size_t first = vertex * width_;
    std::size_t entry = entry_of(vertex, node);
    if (entry == absent) {  // in place of the farthest
      entry = first;
      for (std::size_t e = first + 1; e < first + width_; ++e)
        if (std::tie(out_.distance[e], out_.node[e]) > std::tie(out_.distance[entry], out_.node[entry])) entry = e;
    }
    if (std::tie(distance, node) >= std::tie(out_.distance[entry], out_.node[entry])) return;
    out_.distance[entry] = distance;
    out_.node[entry] = node;
    if (settled_[entry] != 0) --done_[vertex];
    settled_[entry] = 0;
    queue_.push({distance, node, vertex});
  }

  /// To the neighbours r of a vertex p that was settled.
  void spread(const Label& at) {
    const Vec3& p = graph_.vertices[at.vertex];
    known_.clear();
    for (const Index q : graph_[at.vertex])
      if (const std::size_t e = entry_of(q, at.node); e != absent && settled_[e] != 0)
        known_.push_back({q, out_.distance[e], graph_.vertices[q] - p});
    for (const Index r : graph_[at.vertex]) {
      if (done_[r] == width_) continue;
      if (const std::size_t e = entry_of(r, at.node); e != absent && settled_[e] != 0) continue;
      const Vec3 to_r = graph_.vertices[r] - p;
      double shortest = at.distance + to_r.norm();
      const std::span<const Index> around = graph_[r];
      for (const Known& q : known_)
        if (std::binary_search(around.begin(), around.end(), q.vertex))
          shortest = std::min(shortest, through_triangle(at.distance, q, to_r));
      offer(r, at.node, shortest);
    }
  }

  struct Known {
    Index vertex;
    double distance;
    Vec3 from_p;
  };

  /// p at (0, 0), q at (c, 0), r at (x, y > 0), the node's image at (s, -h); infinite where its line to r does not pass
  /// between p and q.
  static double through_triangle(double a, const Known& q, const Vec3& to_r) {
    const double c = q.from_p.norm(), b = q.distance;
    const double x = q.from_p.dot(to_r) / c, s = (a * a - b * b + c * c) / (2 * c);
    const double y_square = to_r.squaredNorm() - x * x, h_square = a * a - s * s;
    if (!(y_square > 0) || !(h_square >= 0)) return infinite;
    const double y = std::sqrt(y_square), h = std::sqrt(h_square);
    const double crossing = s + (x - s) * h / (y + h);
    if (!(crossing >= 0 && crossing <= c)) return infinite;
    return std::sqrt((x - s) * (x - s) + (y + h) * (y + h));
  }

  void sort_rows() {
    std::vector<std::pair<double, Index>> row(width_);
    for (std::size_t first = 0; first < out_.node.size(); first += width_) {
      for (std::size_t e = 0; e < width_; ++e) row[e] = {out_.distance[first + e], out_.node[first + e]};
      std::sort(row.begin(), row.end());
      for (std::size_t e = 0; e < width_; ++e) std::tie(out_.distance[first + e], out_.node[first + e]) = row[e];
    }
  }

  const NeighbourGraph& graph_;
  std::span<const Vec3> nodes_;
  const Curtains& curtains_;
  std::size_t width_;
  NearestNodes out_;           ///< while it runs: the best ways known so far, in no order
  std::vector<char> settled_;  ///< of each entry of out_
  std::vector<Index> done_;    ///< entries of each vertex that are settled
  std::priority_queue<Label> queue_;
  std::vector<Known> known_;
};

}  // namespace

double surface_edge_length(const Shape& shape, std::span<const Vec3> nodes) {
  return edge_length_for(shape, 0.75 * node_spacing(nodes), nodes.size() + shape.size());
}

NeighbourGraph surface_graph(const Shape& shape, const Places& places, std::span<const Vec3> nodes, int enough,
                             const Curtains& curtains) {
  const double spacing = node_spacing(nodes);
  Surface surface = surface_of(shape, places, surface_edge_length(shape, nodes));
  const GraphParts parts = parts_of(surface.vertices.size(), surface.edges);
  if (parts.count > 1) {
    const Edges bridges = bridges_of(surface, parts, nodes, spacing, enough, curtains);
    surface.edges.insert(surface.edges.end(), bridges.begin(), bridges.end());
  }
  if (!curtains.empty())
    std::erase_if(surface.edges,
                  [&](const auto& e) { return curtains.part(surface.vertices[e.first], surface.vertices[e.second]); });
  return neighbour_graph(std::move(surface.vertices), surface.edges);
}

NearestNodes nearest_along_surface(const NeighbourGraph& graph, std::span<const Vec3> nodes, int width,
                                   const Curtains& curtains, const std::function<bool(double)>& progress) {
  CHECK(width >= 1, width);
  return Sweep(graph, nodes, static_cast<std::size_t>(width), curtains).run(progress);
}

}  // namespace sinew
