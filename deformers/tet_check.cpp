#include "deformers/tet_check.h"

#include <algorithm>
#include <cmath>

namespace sinew {

namespace {

struct Region {
  double volume = 0, largest = 0;
  Vec3 inside = Vec3::Zero();  ///< the middle of its largest tet
  int winding = 0;
};

/// Of the surface's and the added vertices; `wrong` as checked_tets says.
std::vector<Region> regions_of(const Shape& shape, const std::vector<Vec3>& vertices, const TetAnswer& answer,
                               std::string& wrong) {
  std::vector<Region> regions;
  for (Index t = 0; t < answer.tets.size(); ++t) {
    const auto& [a, b, c, d] = answer.tets[t];
    const double volume = tet_volume(vertices[a], vertices[b], vertices[c], vertices[d]);
    if (answer.regions[t] > answer.tets.size()) wrong = "a region numbered " + std::to_string(answer.regions[t]);
    if (!(volume > 0))
      wrong = "tet " + std::to_string(t) + " of volume " + number_text(volume) + " around " +
              place_text(shape, vertices[a]);
    if (!wrong.empty()) return {};
    if (regions.size() <= answer.regions[t]) regions.resize(answer.regions[t] + 1);
    Region& region = regions[answer.regions[t]];
    region.volume += volume;
    if (volume <= region.largest) continue;
    region.largest = volume;
    region.inside = (vertices[a] + vertices[b] + vertices[c] + vertices[d]) / 4;
  }
  return regions;
}

/// Triangles of the surface that are no side of a tet.
std::size_t lost_faces(const TetSurface& surface, const TetAnswer& answer) {
  const auto sorted = [](Triangle corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  std::vector<Triangle> sides;
  sides.reserve(4 * answer.tets.size());
  for (const auto& [a, b, c, d] : answer.tets)
    for (const Triangle& side : {Triangle{a, b, c}, Triangle{a, b, d}, Triangle{a, c, d}, Triangle{b, c, d}})
      if (std::max({side[0], side[1], side[2]}) < surface.vertices.size()) sides.push_back(sorted(side));
  std::sort(sides.begin(), sides.end());
  return static_cast<std::size_t>(std::count_if(
      surface.triangles.begin(), surface.triangles.end(),
      [&](const Triangle& triangle) { return !std::binary_search(sides.begin(), sides.end(), sorted(triangle)); }));
}

/// Leaves out added vertices of no tet (inside a cavity).
void drop_unused(TetMesh& mesh) {
  std::vector<Index> number(mesh.vertices.size(), 0);
  for (const Tet& tet : mesh.tets)
    for (const Index v : tet) number[v] = 1;
  std::size_t kept = 0, points = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == 0) continue;
    if (v < mesh.points.size()) mesh.points[points++] = mesh.points[v];
    mesh.vertices[kept] = mesh.vertices[v];
    number[v] = static_cast<Index>(kept++);
  }
  mesh.vertices.resize(kept);
  mesh.points.resize(points);
  for (Tet& tet : mesh.tets)
    for (Index& v : tet) v = number[v];
}

}  // namespace

TetMesh checked_tets(const Shape& shape, const TetSurface& surface, const TetAnswer& answer, std::string& wrong,
                     std::vector<std::string>& notes) {
  TetMesh mesh{surface.vertices, {}, surface.points};
  mesh.vertices.insert(mesh.vertices.end(), answer.added.begin(), answer.added.end());
  std::vector<Region> regions = regions_of(shape, mesh.vertices, answer, wrong);
  if (!wrong.empty()) return mesh;
  double sum = 0;
  for (Region& region : regions) {
    if (region.volume == 0) continue;
    region.winding = winding_number(surface, region.inside);
    sum += region.winding * region.volume;
  }
  const double enclosed = enclosed_volume(surface);
  if (!(std::abs(sum - enclosed) <= 1e-9 * std::abs(enclosed))) {
    wrong = "tets of volume " + number_text(sum) + " where the faces enclose " + number_text(enclosed);
    return mesh;
  }
  for (Index t = 0; t < answer.tets.size(); ++t)
    if (regions[answer.regions[t]].winding != 0) mesh.tets.push_back(answer.tets[t]);
  if (const std::size_t lost = lost_faces(surface, answer); lost > 0)
    notes.push_back(counted(lost, "triangle", "triangles") + " of the surface cut into smaller ones");
  drop_unused(mesh);
  return mesh;
}

}  // namespace sinew
