#include "engine/geometry/topology.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/geometry/nearest.h"
#include "engine/geometry/parallel.h"

namespace sinew {

namespace {

/// A closed box from (0, 0, 0) to `size`, of quads that look outwards.
Shape box(const Vec3& size) {
  Shape shape;
  for (int i = 0; i < 8; ++i)
    shape.positions.emplace_back((i & 1) * size.x(), (i >> 1 & 1) * size.y(), (i >> 2) * size.z());
  const Index quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& quad : quads) shape.faces.add(quad);
  return shape;
}

/// A patch of 20 x 20 points, spacing 0.01, at `at`.
void add_patch(Shape& shape, const Vec3& at) {
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) shape.positions.push_back(at + Vec3(0.01 * x, 0.01 * y, 0));
}

}  // namespace

TEST(Components, OfACloudAreIslands) {
  Shape shape;
  add_patch(shape, Vec3::Zero());
  add_patch(shape, Vec3(0.5, 0, 0));
  shape.positions.emplace_back(0.1, 0.1, 0.3);       // an outlier
  shape.positions.emplace_back(std::nan(""), 0, 0);  // not a point at all
  add_patch(shape, Vec3(0.205, 0, 0));               // 0.015 from the first
  const Components components = connected_components(shape);
  EXPECT_EQ(components.count, 3u);
  EXPECT_EQ(components.of_point[0], 0u);
  EXPECT_EQ(components.of_point[400], 1u);
  EXPECT_EQ(components.of_point[800], 2u);
  EXPECT_EQ(components.of_point[801], Components::none);
  EXPECT_EQ(components.of_point[802], 0u);
}

TEST(Components, OfFacesAreJoinedByFacesOnly) {
  Shape shape = box(Vec3(1, 1, 1));
  const Shape other = box(Vec3(1, 1, 1));
  for (const Vec3& p : other.positions) shape.positions.push_back(p);  // at the same place, but not joined
  shape.positions.emplace_back(0.5, 0.5, 0.5);                         // a point of no face
  for (std::size_t f = 0; f < 6; ++f) {
    std::vector<Index> corners(other.faces[f].begin(), other.faces[f].end());
    for (Index& c : corners) c += 8;
    shape.faces.add(corners);
  }
  EXPECT_EQ(connected_components(shape).count, 3u);
  EXPECT_EQ(connected_components(Shape{}).count, 0u);
}

TEST(Topology, EdgesTrianglesNormals) {
  const Shape shape = box(Vec3(2, 1, 1));
  EXPECT_EQ(edges_of(shape.faces).size(), 12u);
  EXPECT_EQ(triangles_of(shape.faces).size(), 36u);
  const std::vector<Vec3> normals = vertex_normals(shape);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(normals[i].norm(), 1, 1e-12);
    EXPECT_GT(normals[i].dot(shape.positions[i] - Vec3(1, 0.5, 0.5)), 0);
  }
}

TEST(Quality, MeasuresStretchAndVolume) {
  const Shape shape = box(Vec3(1, 1, 1));
  std::vector<Vec3> bent = shape.positions;
  for (Vec3& p : bent) p.x() *= 1.5;
  const Quality quality = quality_of(shape, bent);
  EXPECT_TRUE(quality.closed);
  EXPECT_NEAR(quality.volume_change, 0.5, 1e-12);
  EXPECT_NEAR(quality.edge_max, 0.5, 1e-12);
  EXPECT_NEAR(quality.edge_rms, std::sqrt(4 * 0.25 / 12), 1e-12);
  // Far away the volume is as exact.
  Shape far = shape;
  for (Vec3& p : far.positions) p += Vec3(1e6, 0, 0);
  std::vector<Vec3> far_bent = bent;
  for (Vec3& p : far_bent) p += Vec3(1e6, 0, 0);
  EXPECT_NEAR(quality_of(far, far_bent).volume_change, 0.5, 1e-9);
}

TEST(Quality, OpenOrBadlyOrientedShapesHaveNoVolume) {
  Shape open = box(Vec3(1, 1, 1));
  open.faces.offsets.pop_back();
  open.faces.points.resize(20);
  EXPECT_FALSE(quality_of(open, open.positions).closed);
  Shape flipped = box(Vec3(1, 1, 1));
  std::swap(flipped.faces.points[0], flipped.faces.points[2]);
  EXPECT_FALSE(quality_of(flipped, flipped.positions).closed);
  Shape cloud;
  cloud.positions = {Vec3(0, 0, 0)};
  EXPECT_FALSE(quality_of(cloud, cloud.positions).has_edges);
}

TEST(NearestTree, IsExactAndTheSameForAnyNumberOfThreads) {
  std::vector<Vec3> points, queries;
  for (int i = 0; i < 3000; ++i)
    points.emplace_back(std::sin(12.9898 * i), std::cos(78.233 * i), std::sin(37.719 * i + 1));
  for (int i = 0; i < 2000; ++i) queries.emplace_back(std::sin(3.1 * i), std::sin(1.7 * i + 2), std::cos(0.3 * i));
  queries[5] = Vec3(std::nan(""), 0, 0);
  const NearestTree tree(points);
  std::vector<std::vector<std::uint32_t>> results;
  std::vector<double> distance(queries.size() * 5);
  for (const int threads : {1, 4}) {
    set_thread_count(threads);
    std::vector<std::uint32_t> index(queries.size() * 5);
    tree.nearest(queries, 5, index, distance);
    results.push_back(index);
  }
  set_thread_count(2);
  EXPECT_EQ(results[0], results[1]);
  for (std::size_t q = 0; q < queries.size(); q += 37) {
    std::vector<std::pair<double, std::uint32_t>> all;
    for (std::uint32_t i = 0; i < points.size(); ++i) all.emplace_back((points[i] - queries[q]).squaredNorm(), i);
    std::sort(all.begin(), all.end());
    for (std::size_t n = 0; n < 5; ++n) EXPECT_EQ(results[0][q * 5 + n], all[n].second);
  }
  for (std::size_t n = 0; n < 5; ++n) EXPECT_EQ(results[0][25 + n], NearestTree::none);
}

TEST(NearestTree, FewerPointsThanNeighbours) {
  const std::vector<Vec3> two = {Vec3(0, 0, 0), Vec3(1, 0, 0)}, query = {Vec3(0.9, 0, 0)};
  std::vector<std::uint32_t> index(4);
  std::vector<double> distance(4);
  NearestTree(two).nearest(query, 4, index, distance);
  EXPECT_EQ(index, (std::vector<std::uint32_t>{1, 0, NearestTree::none, NearestTree::none}));
  EXPECT_TRUE(std::isinf(distance[3]));
  NearestTree(std::vector<Vec3>{}).nearest(query, 4, index, distance);
  EXPECT_EQ(index[0], NearestTree::none);
}

}  // namespace sinew
