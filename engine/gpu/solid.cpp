#include "engine/gpu/solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "engine/geometry/bounds.h"
#include "engine/geometry/check.h"

namespace sinew::gpu {

namespace {

constexpr Color cut_tint = Color::hex(0xd9b36c);
constexpr double cut_strength = 0.55;
constexpr Color soft = Color::hex(0x35b58e), stiff = Color::hex(0xd8405f);

std::uint8_t mixed(std::uint8_t from, std::uint8_t to, double part) {
  return static_cast<std::uint8_t>(std::lround(from + part * (to - from)));
}

PointColor mixed(PointColor from, Color to, double part) {
  return {mixed(from.r, to.r, part), mixed(from.g, to.g, part), mixed(from.b, to.b, part), from.marks};
}

/// Which tets are seen.
std::vector<bool> seen_tets(std::span<const Vec3> rest, std::span<const Tet> tets, const Section& section) {
  CHECK(section.axis >= 0 && section.axis < 3, section.axis);
  const Bounds bounds = bounds_of(rest);
  std::vector<bool> seen(tets.size(), false);
  if (bounds.empty()) return seen;
  const double low = bounds.min[section.axis], high = bounds.max[section.axis];
  const double plane = low + section.at * (high - low);
  for (std::size_t j = 0; j < tets.size(); ++j) {
    double middle = 0;
    for (const Index v : tets[j]) middle += rest[v][section.axis] / 4;
    seen[j] = middle <= plane;
  }
  return seen;
}

struct Side {
  std::array<Index, 3> key;  ///< sorted corners
  Index tet;
  bool operator<(const Side& other) const { return std::tie(key, tet) < std::tie(other.key, other.tet); }
};

}  // namespace

SolidFaces faces_of(std::span<const Vec3> rest, std::span<const Tet> tets, const std::optional<Section>& section) {
  const std::vector<bool> seen = section ? seen_tets(rest, tets, *section) : std::vector<bool>(tets.size(), true);
  std::vector<Side> sides;
  sides.reserve(4 * tets.size());
  for (std::size_t j = 0; j < tets.size(); ++j)
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      Side side{{}, static_cast<Index>(j)};
      for (std::size_t a = 0, k = 0; a < 4; ++a)
        if (a != left_out) side.key[k++] = tets[j][a];
      std::sort(side.key.begin(), side.key.end());
      sides.push_back(side);
    }
  std::sort(sides.begin(), sides.end());
  SolidFaces out;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    std::size_t shown = 0;
    for (end = begin; end < sides.size() && sides[end].key == sides[begin].key; ++end) shown += seen[sides[end].tet];
    if (shown != 1) continue;
    out.faces.push_back(sides[begin].key);
    out.inner.push_back(end - begin > 1);
    const auto& [a, b, c] = sides[begin].key;
    out.edges.insert(out.edges.end(), {{a, b}, {b, c}, {a, c}});
  }
  std::sort(out.edges.begin(), out.edges.end());
  out.edges.erase(std::unique(out.edges.begin(), out.edges.end()), out.edges.end());
  return out;
}

PointColor stiffness_color(PointColor plain, double factor) {
  if (!(factor > 0) || factor == 1) return plain;
  const double t = std::clamp(std::log2(factor) / 4, -1.0, 1.0);
  return mixed(plain, t < 0 ? soft : stiff, 0.3 + 0.55 * std::abs(t));
}

SolidItem create_solid(const Device& device, const SolidFaces& faces, std::span<const Vec3> at,
                       std::span<const PointColor> colors) {
  CHECK(colors.size() == at.size(), colors.size(), at.size());
  std::vector<Vec3> positions;
  std::vector<PointColor> shown;
  for (std::size_t f = 0; f < faces.faces.size(); ++f)
    for (const Index v : faces.faces[f]) {
      positions.push_back(at[v]);
      shown.push_back(faces.inner[f] ? mixed(colors[v], cut_tint, cut_strength) : colors[v]);
    }
  SolidItem out;
  out.points = create_points(device, false, positions, {});
  set_colors(out.points, shown);
  std::vector<std::uint32_t> corners(positions.size());
  std::iota(corners.begin(), corners.end(), 0u);
  out.triangles = create_triangles(device, corners);
  return out;
}

void add_edges(const SolidFaces& faces, std::span<const Vec3> at, const Line& like, Scene& scene) {
  for (const auto& [a, b] : faces.edges) {
    Line line = like;
    line.from = at[a];
    line.to = at[b];
    scene.lines.push_back(line);
  }
}

}  // namespace sinew::gpu
