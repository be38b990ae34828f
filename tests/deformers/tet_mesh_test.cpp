/// Tets of closed surfaces: what is filled, what comes back, what is refused is in tet_hostile_test.cpp.

#include "deformers/tet_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "apps/samples/meshes.h"

namespace sinew {

namespace {

double volume_of(const TetMesh& mesh) {
  double sum = 0;
  for (const Tet& t : mesh.tets)
    sum += tet_volume(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], mesh.vertices[t[3]]);
  return sum;
}

Shape cube() {
  Shape shape;
  for (int i = 0; i < 8; ++i) shape.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  for (const auto& quad : std::vector<std::array<Index, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
    shape.faces.add(quad);
  return shape;
}

TetMesh tets_of(const Shape& shape, const TetMeshOptions& options = {}) {
  std::vector<std::string> notes;
  return tetrahedralized(shape, options, notes).value();
}

}  // namespace

TEST(TetMesh, FillsACube) {
  const TetMesh mesh = tets_of(cube());
  EXPECT_NEAR(volume_of(mesh), 1, 1e-12);
  EXPECT_EQ(mesh.points.size(), 8u);
  EXPECT_EQ(mesh.boundary().faces.size(), 12u);
}

TEST(TetMesh, FillsTheBar) {
  const Shape bar = samples::bar();
  const TetMesh mesh = tets_of(bar, {.vertices = 10000});
  EXPECT_NEAR(volume_of(mesh), 0.5 * 0.5 * 1.65, 1e-8) << "its coordinates are floats";
}

}  // namespace sinew
