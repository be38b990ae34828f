#include "deformers/graph_nodes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "engine/geometry/bounds.h"
#include "engine/geometry/nearest.h"
#include "engine/geometry/random.h"
#include "engine/geometry/topology.h"

namespace sinew {

namespace {

/// Enough that the removal radius, not the density of the candidates, shapes the result.
std::size_t candidates_for(std::size_t count) {
  return std::max<std::size_t>(20000, 100 * count);
}

/// Random points on the faces, uniform by area; none where all faces are degenerate.
std::vector<Vec3> points_on_faces(const Shape& shape, std::size_t count, std::uint64_t seed) {
  const std::vector<Index> triangles = triangles_of(shape.faces);
  std::vector<double> area_before{0};
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const Vec3& a = shape.positions[triangles[t]];
    const double area = (shape.positions[triangles[t + 1]] - a).cross(shape.positions[triangles[t + 2]] - a).norm();
    area_before.push_back(area_before.back() + (std::isfinite(area) ? area : 0));
  }
  std::vector<Vec3> out;
  if (!(area_before.back() > 0)) return out;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = random_unit(seed, 3 * i) * area_before.back();
    const auto above = std::upper_bound(area_before.begin(), area_before.end(), at);
    const auto t = static_cast<std::size_t>(above - area_before.begin() - 1) * 3;
    if (t >= triangles.size()) continue;
    const double u = std::sqrt(random_unit(seed, 3 * i + 1)), v = random_unit(seed, 3 * i + 2);
    out.push_back((1 - u) * shape.positions[triangles[t]] + u * (1 - v) * shape.positions[triangles[t + 1]] +
                  u * v * shape.positions[triangles[t + 2]]);
  }
  return out;
}

/// The points that are candidates but for outliers, in random order.
std::vector<Vec3> all_candidates(const Shape& shape, std::size_t count, std::uint64_t seed) {
  const std::size_t wanted = candidates_for(count);
  std::vector<Vec3> points;
  for (const Vec3& p : shape.positions)
    if (p.allFinite()) points.push_back(p);
  if (points.size() < wanted && !shape.faces.empty()) {
    const std::vector<Vec3> more = points_on_faces(shape, wanted - points.size(), seed);
    points.insert(points.end(), more.begin(), more.end());
  }
  std::vector<std::pair<std::uint64_t, std::size_t>> order(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) order[i] = {random_bits(seed + 1, i), i};
  std::sort(order.begin(), order.end());
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < std::min(order.size(), wanted); ++i) out.push_back(points[order[i].second]);
  return out;
}

/// Without points that stand apart: those much farther from their neighbours than these are from theirs [after Breunig
/// et al., "LOF: identifying density-based local outliers", 2000]. A scan's outliers would otherwise each take a node.
std::vector<Vec3> without_outliers(const std::vector<Vec3>& points) {
  constexpr std::size_t k = 6;  // five neighbours and the point itself
  constexpr double apart = 4;
  if (points.size() < 100 * k) return points;
  std::vector<std::uint32_t> near(points.size() * k);
  std::vector<double> distance(points.size() * k);
  NearestTree(points).nearest(points, static_cast<int>(k), near, distance);
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<double, k - 1> theirs{};
    for (std::size_t n = 1; n < k; ++n) theirs[n - 1] = distance[near[i * k + n] * k + k - 1];
    std::nth_element(theirs.begin(), theirs.begin() + 2, theirs.end());
    if (distance[i * k + k - 1] <= apart * theirs[2] || theirs[2] == 0) out.push_back(points[i]);
  }
  return out;
}

/// A hash grid of cells as wide as the radius. A kept point is entered in its cell and the 26 around: there are few of
/// them, and a query then looks at one cell.
class Grid {
 public:
  explicit Grid(double cell) : cell_(cell) {}

  bool has_near(const std::vector<Vec3>& points, const Vec3& p) const {
    const auto found = cells_.find(key(p));
    return found != cells_.end() && std::any_of(found->second.begin(), found->second.end(), [&](std::size_t i) {
             return (points[i] - p).squaredNorm() <= cell_ * cell_;
           });
  }
  void add(const Vec3& p, std::size_t i) {
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) cells_[key(p + cell_ * Vec3(x, y, z))].push_back(i);
  }

 private:
  std::uint64_t key(const Vec3& p) const {
    std::uint64_t k = 0;
    for (int c = 0; c < 3; ++c)
      k = k << 21 | (static_cast<std::uint64_t>(std::floor(p[c] / cell_) + 0x80000) & 0x1fffff);
    return k;
  }
  double cell_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;
};

/// Keeps each point that has no earlier kept one within `radius`: the same as removing around kept ones, in the same
/// order.
std::vector<Vec3> keep_apart(const std::vector<Vec3>& points, double radius) {
  Grid grid(radius);
  std::vector<Vec3> kept;
  for (const Vec3& p : points) {
    if (grid.has_near(kept, p)) continue;
    grid.add(p, kept.size());
    kept.push_back(p);
  }
  return kept;
}

/// Removes nodes, always one of the closest pair, until `count` are left.
void thin(std::vector<Vec3>& nodes, std::size_t count) {
  while (nodes.size() > count) {
    const NearestTree tree(nodes);
    std::vector<std::uint32_t> index(nodes.size() * 2);
    std::vector<double> distance(nodes.size() * 2);
    tree.nearest(nodes, 2, index, distance);
    std::size_t closest = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (distance[2 * i + 1] < distance[2 * closest + 1]) closest = i;
    nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(closest));
  }
}

}  // namespace

std::vector<Vec3> node_candidates(const Shape& shape, std::size_t count, std::uint64_t seed) {
  const std::vector<Vec3> points = all_candidates(shape, count, seed);
  return shape.faces.empty() ? without_outliers(points) : points;
}

std::vector<Vec3> sample_nodes(const Shape& shape, std::size_t count, std::uint64_t seed) {
  const Normalization unit = normalization_of(bounds_of(shape.positions));
  std::vector<Vec3> points = node_candidates(shape, count, seed);
  if (points.empty() || count == 0) return {};
  for (Vec3& p : points) p = unit.apply(p);  // the diagonal at 1

  // A surface of area about 1/2 under a diagonal of 1 takes this radius; from there to one that keeps enough.
  double low = 0.7 / std::sqrt(static_cast<double>(count)), high = 2;
  std::vector<Vec3> nodes = keep_apart(points, low);
  while (nodes.size() < count && low > 1e-6) {
    high = low;
    low *= 0.7;
    nodes = keep_apart(points, low);
  }
  // Bisection: `low` keeps at least `count`, `high` fewer.
  for (int step = 0; step < 40 && nodes.size() > count && high - low > 1e-4 * low; ++step) {
    const double middle = std::sqrt(low * high);
    std::vector<Vec3> kept = keep_apart(points, middle);
    if (kept.size() >= count) {
      low = middle;
      nodes = std::move(kept);
    } else {
      high = middle;
    }
  }
  thin(nodes, count);
  for (Vec3& node : nodes) node = unit.undo(node);
  return nodes;
}

}  // namespace sinew
