#include "engine/geometry/surface_pieces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/geometry/topology.h"
#include "engine/geometry/triangle.h"

namespace sinew {

namespace {

using Triangle = std::array<Vec3, 3>;

Vec3 normal_of(const Triangle& t) {
  return (t[1] - t[0]).cross(t[2] - t[0]).stableNormalized();
}

void halve(const Triangle& t, double longest, std::vector<Triangle>& out) {
  std::size_t k = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if ((t[(i + 1) % 3] - t[i]).squaredNorm() > (t[(k + 1) % 3] - t[k]).squaredNorm()) k = i;
  const Vec3 &a = t[k], &b = t[(k + 1) % 3], &c = t[(k + 2) % 3];
  if (!((b - a).norm() > longest)) {
    out.push_back(t);
    return;
  }
  const Vec3 middle = 0.5 * (a + b);
  halve({a, middle, c}, longest, out);
  halve({middle, b, c}, longest, out);
}

bool before(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

Vec3 centre_of(const Triangle& t) {
  return (t[0] + t[1] + t[2]) / 3;
}

}  // namespace

SurfacePieces::SurfacePieces(const Shape& shape, double longest)
    : pieces_(pieces_of(shape, longest)), centres_(centres_of(pieces_)) {}

std::vector<SurfacePieces::Piece> SurfacePieces::pieces_of(const Shape& shape, double longest) {
  std::vector<Piece> out;
  const std::vector<Index> corners = triangles_of(shape.faces);
  for (std::size_t c = 0; c + 2 < corners.size(); c += 3) {
    const Triangle t{shape.positions[corners[c]], shape.positions[corners[c + 1]], shape.positions[corners[c + 2]]};
    if (t[0].allFinite() && t[1].allFinite() && t[2].allFinite()) halve(t, longest, out);
  }
  if (shape.faces.empty())
    for (const Vec3& p : shape.positions)
      if (p.allFinite()) out.push_back({p, p, p});
  std::sort(out.begin(), out.end(), [](const Piece& a, const Piece& b) { return before(centre_of(a), centre_of(b)); });
  return out;
}

std::vector<Vec3> SurfacePieces::centres_of(std::span<const Piece> pieces) {
  std::vector<Vec3> out;
  out.reserve(pieces.size());
  for (const Piece& piece : pieces) out.push_back(centre_of(piece));
  return out;
}

SurfacePieces::Place SurfacePieces::nearest(const Vec3& p) const {
  constexpr int most = 16;
  std::array<std::uint32_t, most> near{};
  std::array<double, most> distance{};
  centres_.nearest(std::span(&p, 1), most, near, distance);
  Place best;
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t i : near) {
    if (i == NearestTree::none) break;
    const Triangle& t = pieces_[i];
    const Vec3 w = nearest_in_triangle(p, t[0], t[1], t[2]), q = w[0] * t[0] + w[1] * t[1] + w[2] * t[2];
    if (const double d = (q - p).squaredNorm(); d < least) {
      least = d;
      best = {q, normal_of(pieces_[i])};
    }
  }
  return best;
}

std::vector<Vec3> SurfacePieces::spread(std::size_t count) const {
  const std::span<const Vec3> all = centres_.points();
  std::vector<Vec3> out;
  if (all.empty()) return out;
  const Vec3 mean = std::accumulate(all.begin(), all.end(), Vec3(0, 0, 0)) / static_cast<double>(all.size());
  std::vector<double> distance(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) distance[i] = (all[i] - mean).squaredNorm();
  for (bool first = true; out.size() < count; first = false) {
    const auto farthest = std::max_element(distance.begin(), distance.end());
    if (!first && !(*farthest > 0)) break;
    const Vec3 next = all[static_cast<std::size_t>(farthest - distance.begin())];
    out.push_back(next);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double d = (all[i] - next).squaredNorm();
      distance[i] = first ? d : std::min(distance[i], d);
    }
  }
  return out;
}

}  // namespace sinew
