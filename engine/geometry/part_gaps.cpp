#include "engine/geometry/part_gaps.h"

#include <algorithm>
#include <limits>

#include "engine/geometry/union_find.h"

namespace sinew {

namespace {

constexpr Index none = ~Index{0};
constexpr double infinite = std::numeric_limits<double>::infinity();

/// A k-d tree whose nodes know whether all of their points bear one label, so that a search for points of another label
/// passes over whole parts.
class LabelTree {
 public:
  explicit LabelTree(std::span<const Vec3> points) : points_(points), order_(points.size()), label_(points.size(), 0) {
    for (Index i = 0; i < order_.size(); ++i) order_[i] = i;
    if (!order_.empty()) build(0, static_cast<Index>(order_.size()));
  }

  void set_labels(std::span<const Index> label_of_point) {
    label_.assign(label_of_point.begin(), label_of_point.end());
    // Children stand behind their parent.
    for (std::size_t k = nodes_.size(); k-- > 0;) {
      Node& node = nodes_[k];
      if (node.right != 0) {
        const Index left = nodes_[k + 1].label;
        node.label = left == nodes_[node.right].label ? left : none;
        continue;
      }
      node.label = label_[order_[node.begin]];
      for (Index i = node.begin + 1; i < node.end; ++i)
        if (label_[order_[i]] != node.label) node.label = none;
    }
  }
  Index label(Index point) const { return label_[point]; }

  struct Found {
    double square = infinite;
    Index point = none;
  };
  /// The nearest point to p with a label that is wanted, within `square`; of equally near ones the lowest.
  template <class Wanted, class Allowed>
  Found nearest(const Vec3& p, double square, const Wanted& wanted, const Allowed& allowed) const {
    Found best{square, none};
    if (!nodes_.empty()) search(0, p, wanted, allowed, best);
    return best;
  }

 private:
  struct Node {
    Vec3 min, max;
    Index begin, end;  ///< of order_
    Index right = 0;   ///< its left child follows it; 0: a leaf
    Index label = 0;   ///< of all its points, or none
  };

  Index build(Index begin, Index end) {
    constexpr Index leaf = 8;
    const auto index = static_cast<Index>(nodes_.size());
    Node node{points_[order_[begin]], points_[order_[begin]], begin, end};
    for (Index i = begin; i < end; ++i) {
      node.min = node.min.cwiseMin(points_[order_[i]]);
      node.max = node.max.cwiseMax(points_[order_[i]]);
    }
    nodes_.push_back(node);
    if (end - begin <= leaf) return index;
    Eigen::Index axis = 0;
    (node.max - node.min).maxCoeff(&axis);
    const Index middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](Index a, Index b) { return std::pair(points_[a][axis], a) < std::pair(points_[b][axis], b); });
    build(begin, middle);
    nodes_[index].right = build(middle, end);
    return index;
  }

  double square_distance(const Node& node, const Vec3& p) const {
    return (p - p.cwiseMax(node.min).cwiseMin(node.max)).squaredNorm();
  }

  template <class Wanted, class Allowed>
  void search(Index index, const Vec3& p, const Wanted& wanted, const Allowed& allowed, Found& best) const {
    const Node& node = nodes_[index];
    if (node.label != none && !wanted(node.label)) return;
    if (node.right == 0) {
      for (Index i = node.begin; i < node.end; ++i) {
        const Index q = order_[i];
        const double square = (points_[q] - p).squaredNorm();
        if (square > best.square || (square == best.square && q >= best.point)) continue;
        if (wanted(label_[q]) && allowed(q)) best = {square, q};
      }
      return;
    }
    Index near = index + 1, far = node.right;
    double near_square = square_distance(nodes_[near], p), far_square = square_distance(nodes_[far], p);
    if (far_square < near_square) {
      std::swap(near, far);
      std::swap(near_square, far_square);
    }
    if (near_square <= best.square) search(near, p, wanted, allowed, best);
    if (far_square <= best.square) search(far, p, wanted, allowed, best);
  }

  std::span<const Vec3> points_;
  std::vector<Index> order_, label_;
  std::vector<Node> nodes_;
};

class Bridges {
 public:
  Bridges(std::span<const Vec3> points, const GraphParts& parts, const BridgeWishes& wishes, const Curtains& curtains)
      : points_(points),
        parts_(parts),
        wishes_(wishes),
        curtains_(curtains),
        tree_(points),
        sets_(parts.count),
        weight_(wishes.weight.begin(), wishes.weight.end()) {}

  Edges build() {
    join_touching();
    while (join_nearest()) {
    }
    widen();
    return std::move(edges_);
  }

 private:
  LabelTree::Found nearest(Index p, double square, const auto& wanted) const {
    return tree_.nearest(points_[p], square, wanted,
                         [&](Index q) { return curtains_.empty() || !curtains_.part(points_[p], points_[q]); });
  }

  bool join(Index part_a, Index part_b) {
    const Index a = sets_.root(part_a), b = sets_.root(part_b);
    if (a == b) return false;
    sets_.join(a, b);
    weight_[sets_.root(a)] = weight_[a] + weight_[b];
    return true;
  }

  void join_touching() {
    tree_.set_labels(parts_.of_vertex);
    for (Index p = 0; p < points_.size(); ++p) {
      const Index own = parts_.of_vertex[p];
      const auto found = nearest(p, wishes_.touch * wishes_.touch, [&](Index part) { return part != own; });
      if (found.point == none) continue;
      edges_.emplace_back(p, found.point);
      join(own, parts_.of_vertex[found.point]);
    }
  }

  /// One round; false where nothing was joined.
  bool join_nearest() {
    std::vector<Index> set_of_point(points_.size());
    for (Index p = 0; p < points_.size(); ++p) set_of_point[p] = sets_.root(parts_.of_vertex[p]);
    tree_.set_labels(set_of_point);
    struct Gap {
      double square = infinite;
      Index from = none, to = none;
    };
    std::vector<Gap> gaps(parts_.count);
    for (Index s = 0; s < parts_.count; ++s)
      if (weight_[s] >= wishes_.enough) gaps[s].square = wishes_.reach * wishes_.reach;
    for (Index p = 0; p < points_.size(); ++p) {
      Gap& gap = gaps[set_of_point[p]];
      const auto found = nearest(p, gap.square, [&](Index set) { return set != set_of_point[p]; });
      if (found.point != none && (found.square < gap.square || gap.from == none)) gap = {found.square, p, found.point};
    }
    bool any = false;
    for (const Gap& gap : gaps) {
      if (gap.from == none || !join(parts_.of_vertex[gap.from], parts_.of_vertex[gap.to])) continue;
      joined_.push_back({gap.from, gap.to});
      any = true;
    }
    return any;
  }

  void widen() {
    if (joined_.empty()) return;
    tree_.set_labels(parts_.of_vertex);
    std::vector<std::vector<Index>> points_of(parts_.count);
    for (Index p = 0; p < points_.size(); ++p) points_of[parts_.of_vertex[p]].push_back(p);
    for (const auto& [a, b] : joined_) {
      Index small = parts_.of_vertex[a], other = parts_.of_vertex[b];
      if (points_of[other].size() < points_of[small].size()) std::swap(small, other);
      const double within = 2 * (points_[a] - points_[b]).norm() + wishes_.spacing;
      edges_.emplace_back(a, b);
      for (const Index p : points_of[small]) {
        const auto found = nearest(p, within * within, [&](Index part) { return part == other; });
        if (found.point != none) edges_.emplace_back(p, found.point);
      }
    }
  }

  std::span<const Vec3> points_;
  const GraphParts& parts_;
  const BridgeWishes& wishes_;
  const Curtains& curtains_;
  LabelTree tree_;
  UnionFind sets_;  ///< of parts
  std::vector<Index> weight_;
  Edges joined_, edges_;
};

}  // namespace

Edges bridges_between(std::span<const Vec3> points, const GraphParts& parts, const BridgeWishes& wishes,
                      const Curtains& curtains) {
  CHECK(wishes.weight.size() == parts.count && parts.of_vertex.size() == points.size(), wishes.weight.size(),
        parts.count, points.size());
  if (parts.count <= 1) return {};
  return Bridges(points, parts, wishes, curtains).build();
}

}  // namespace sinew
