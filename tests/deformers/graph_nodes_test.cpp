#include "deformers/graph_nodes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/nearest.h"
#include "engine/geometry/random.h"

namespace sinew {

namespace {

/// Points on the unit sphere, far denser on one half.
Shape sphere_scan(std::size_t n) {
  Shape shape;
  for (std::size_t i = 0; i < n; ++i) {
    const double z = 1 - 2 * std::pow(random_unit(1, 2 * i), 3), a = 6.283185307 * random_unit(1, 2 * i + 1);
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    shape.positions.emplace_back(r * std::cos(a), r * std::sin(a), z);
  }
  return shape;
}

/// A grid of quads in the plane.
Shape sheet(Index side) {
  Shape shape;
  for (Index y = 0; y < side; ++y)
    for (Index x = 0; x < side; ++x) shape.positions.emplace_back(x, y, 0.3 * std::sin(0.9 * x) * std::cos(0.7 * y));
  for (Index y = 0; y + 1 < side; ++y)
    for (Index x = 0; x + 1 < side; ++x) {
      const Index a = y * side + x;
      const Index quad[] = {a, a + 1, a + side + 1, a + side};
      shape.faces.add(quad);
    }
  return shape;
}

/// Smallest distance between two nodes, and largest from a point of the shape to its nearest node.
std::pair<double, double> gaps(const Shape& shape, const std::vector<Vec3>& nodes) {
  const NearestTree tree(nodes);
  std::vector<std::uint32_t> index(2 * nodes.size()), of_point(shape.size());
  std::vector<double> distance(2 * nodes.size()), to_point(shape.size());
  tree.nearest(nodes, 2, index, distance);
  tree.nearest(shape.positions, 1, of_point, to_point);
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < nodes.size(); ++i) least = std::min(least, distance[2 * i + 1]);
  return {least, *std::max_element(to_point.begin(), to_point.end())};
}

}  // namespace

TEST(GraphNodes, ExactlyAsManyAsWantedAndEvenlySpread) {
  const Shape shape = sphere_scan(20000);
  for (const std::size_t count : {1u, 7u, 100u, 226u, 1000u}) {
    const std::vector<Vec3> nodes = sample_nodes(shape, count, 0);
    ASSERT_EQ(nodes.size(), count);
    if (count < 50) continue;
    const auto [least, reach] = gaps(shape, nodes);
    EXPECT_LT(reach, 1.6 * least) << count;  // a sampling that is dense here and sparse there would fail this
  }
}

TEST(GraphNodes, OutliersOfAScanTakeNone) {
  Shape shape = sphere_scan(20000);
  const std::size_t surface = shape.size();
  for (const double angle : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0})
    for (const double z : {0.0, 0.7})
      shape.positions.push_back(1.3 * Vec3(std::cos(angle), std::sin(angle), z).normalized());
  int taken = 0;
  for (const Vec3& g : sample_nodes(shape, 200, 0)) taken += g.norm() > 1.05;
  EXPECT_EQ(taken, 0);
  // The sparse half of the sphere is not an outlier.
  shape.positions.resize(surface);
  std::size_t sparse = 0;
  for (const Vec3& g : sample_nodes(shape, 200, 0)) sparse += g.z() < -0.5;
  EXPECT_GT(sparse, 40u);
}

TEST(GraphNodes, DependOnTheSeedAndOnNothingElse) {
  const Shape shape = sphere_scan(5000);
  EXPECT_EQ(sample_nodes(shape, 50, 3), sample_nodes(shape, 50, 3));
  EXPECT_NE(sample_nodes(shape, 50, 3), sample_nodes(shape, 50, 4));
}

TEST(GraphNodes, FewerPointsThanNodesAndPointsThatAreNotFinite) {
  Shape shape;
  shape.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 0), Vec3(std::nan(""), 0, 0), Vec3(0, 1, 0)};
  const std::vector<Vec3> nodes = sample_nodes(shape, 100, 0);
  EXPECT_EQ(nodes.size(), 3u);
  for (const Vec3& g : nodes) EXPECT_TRUE(g.allFinite());
  shape.positions = {Vec3(std::nan(""), 0, 0)};
  EXPECT_TRUE(sample_nodes(shape, 10, 0).empty());
  shape.positions.clear();
  EXPECT_TRUE(sample_nodes(shape, 10, 0).empty());
}

TEST(GraphNodes, ACoarseMeshIsSampledOnItsFaces) {
  Shape box = sheet(2);
  const std::vector<Vec3> nodes = sample_nodes(box, 60, 0);
  EXPECT_EQ(nodes.size(), 60u);
  EXPECT_GT(gaps(box, nodes).first, 0.05);
}

TEST(GraphNodes, SimplificationKeepsVerticesApart) {
  const Shape shape = sheet(40);
  std::string note;
  const std::vector<Vec3> nodes = simplify_to_nodes(shape, 150, note);
  EXPECT_LE(nodes.size(), 150u);
  EXPECT_GT(nodes.size(), 100u);
  EXPECT_TRUE(note.empty()) << note;
  for (const Vec3& g : nodes)
    EXPECT_NE(std::find(shape.positions.begin(), shape.positions.end(), g), shape.positions.end());
}

TEST(GraphNodes, SimplificationCountsWhatItCannotUse) {
  Shape shape = sheet(10);
  const Index fin[] = {0, 1, 55}, again[] = {0, 1, 77}, flat[] = {3, 3, 4};
  shape.faces.add(fin);
  shape.faces.add(again);
  shape.faces.add(flat);
  std::string note;
  simplify_to_nodes(shape, 30, note);
  EXPECT_NE(note.find("faces that are degenerate or not manifold were left out"), std::string::npos) << note;
}

}  // namespace sinew
