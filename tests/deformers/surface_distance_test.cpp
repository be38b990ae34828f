#include "deformers/surface_distance.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/random.h"

namespace sinew {

namespace {

/// A sheet of side x side points, 1 apart and shaken, `bend` puts (x, y) into space.
Shape sheet(int side, const std::function<Vec3(double, double)>& bend, bool faces = true) {
  Shape shape;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const auto i = static_cast<std::uint64_t>(y * side + x);
      shape.positions.push_back(bend(x + 0.4 * (random_unit(1, i) - 0.5), y + 0.4 * (random_unit(2, i) - 0.5)));
    }
  for (int y = 0; faces && y + 1 < side; ++y)
    for (int x = 0; x + 1 < side; ++x) {
      const auto i = static_cast<Index>(y * side + x), s = static_cast<Index>(side);
      // Triangles of both ways round, and quads.
      const Index a[] = {i, i + 1, i + s}, b[] = {i + 1, i + s + 1, i + s}, quad[] = {i, i + 1, i + s + 1, i + s};
      if (x % 3 == 0) {
        shape.faces.add(quad);
      } else {
        shape.faces.add(a);
        shape.faces.add(b);
      }
    }
  return shape;
}

Vec3 flat(double x, double y) {
  return {x, y, 0};
}

/// Around a cylinder, four fifths of it.
Vec3 rolled(double x, double y) {
  const double angle = 0.8 * 2 * M_PI * x / 29, r = 29 / (0.8 * 2 * M_PI);
  return {r * std::cos(angle), r * std::sin(angle), y};
}

std::vector<Vec3> nodes_on(const Shape& shape, Index every) {
  std::vector<Vec3> nodes;
  for (Index i = every / 2; i < shape.size(); i += every) nodes.push_back(shape.positions[i]);
  return nodes;
}

struct Bound {
  NeighbourGraph graph;
  NearestNodes near;
};
Bound bound(const Shape& shape, const std::vector<Vec3>& nodes, int width, const std::vector<Cut>& cuts = {}) {
  const Curtains curtains(cuts);
  Bound out{surface_graph(shape, places_of(shape.positions), nodes, width, curtains), {}};
  out.near = nearest_along_surface(out.graph, nodes, width, curtains);
  return out;
}

/// Relative errors of the distances against `exact(point, node)`: largest, and mean of their size.
struct Error {
  double largest = 0, mean = 0;
};
Error error_of(const Bound& b, std::size_t nodes, const std::function<double(Index, Index)>& exact) {
  Error out;
  std::size_t count = 0;
  for (Index v = 0; v < b.graph.size(); ++v) {
    std::vector<double> expected;
    for (Index j = 0; j < nodes; ++j) expected.push_back(exact(v, j));
    std::sort(expected.begin(), expected.end());
    for (std::size_t k = 0; k < b.near.width; ++k) {
      const double e = std::abs(b.near.distance[v * b.near.width + k] - expected[k]) / (expected[k] + 0.5);
      out.largest = std::max(out.largest, e);
      out.mean += e;
      ++count;
    }
  }
  out.mean /= static_cast<double>(count);
  return out;
}

}  // namespace

TEST(SurfaceDistance, OnAFlatSheetIsTheStraightOne) {
  const Shape shape = sheet(30, flat);
  std::vector<Vec3> nodes = nodes_on(shape, 37);
  for (Vec3& g : nodes) g += Vec3(0.2, 0.1, 0);  // nodes need not be points
  const Bound b = bound(shape, nodes, 5);
  const Error error =
      error_of(b, nodes.size(), [&](Index v, Index j) { return (b.graph.vertices[v] - nodes[j]).norm(); });
  EXPECT_LT(error.largest, 0.08);
  EXPECT_LT(error.mean, 0.002);
}

TEST(SurfaceDistance, GoesAroundACylinder) {
  const Shape shape = sheet(30, rolled), unrolled = sheet(30, flat);
  const std::vector<Vec3> nodes = nodes_on(shape, 225), flat_nodes = nodes_on(unrolled, 225);
  ASSERT_EQ(nodes.size(), 4u);
  const Bound b = bound(shape, nodes, 4);
  const Error error =
      error_of(b, nodes.size(), [&](Index v, Index j) { return (unrolled.positions[v] - flat_nodes[j]).norm(); });
  EXPECT_LT(error.largest, 0.05);
  EXPECT_LT(error.mean, 0.01);
}

TEST(SurfaceDistance, OfACloudIsNear) {
  const Shape shape = sheet(30, rolled, false), unrolled = sheet(30, flat);
  const std::vector<Vec3> nodes = nodes_on(shape, 225), flat_nodes = nodes_on(unrolled, 225);
  const Bound b = bound(shape, nodes, 4);
  const Error error =
      error_of(b, nodes.size(), [&](Index v, Index j) { return (unrolled.positions[v] - flat_nodes[j]).norm(); });
  EXPECT_LT(error.largest, 0.05);
  EXPECT_LT(error.mean, 0.02);
}

TEST(SurfaceDistance, FindsTheNearestNodesOfAllAndNotMore) {
  // Width of all nodes is the whole table of distances; a narrower sweep gives its first columns.
  const Shape shape = sheet(20, rolled);
  const std::vector<Vec3> nodes = nodes_on(shape, 29);
  const Bound all = bound(shape, nodes, static_cast<int>(nodes.size())), few = bound(shape, nodes, 5);
  std::size_t same = 0;
  for (Index v = 0; v < all.graph.size(); ++v)
    for (std::size_t k = 0; k < 5; ++k) {
      const double a = all.near.distance[v * all.near.width + k], b = few.near.distance[v * 5 + k];
      // A triangle's corner that is not among the nearest of another can be missing in the narrow one.
      EXPECT_NEAR(a, b, 0.05 * (a + 0.5));
      same += a == b && all.near.node[v * all.near.width + k] == few.near.node[v * 5 + k] ? 1 : 0;
    }
  EXPECT_GT(same, 5 * all.graph.size() * 95 / 100);
}

TEST(SurfaceDistance, ACutSendsTheWayAround) {
  const Shape shape = sheet(30, flat);
  const Cut cut{{Vec3(15.5, -1, -1), Vec3(15.5, 20.3, -1)}, Vec3(0, 0, 2)};
  const std::vector<Vec3> node = {shape.positions[5 * 30 + 10]};
  const Bound b = bound(shape, node, 1, {cut});
  const Curtains curtains(std::vector{cut});
  const Vec3 corner(15.5, 20.3, 0);
  for (Index v = 0; v < b.graph.size(); ++v) {
    const Vec3& p = b.graph.vertices[v];
    const double straight = (p - node[0]).norm(), around = (p - corner).norm() + (corner - node[0]).norm();
    EXPECT_NEAR(b.near.distance[v], curtains.part(p, node[0]) ? around : straight, 0.05 * around + 0.5);
  }
  // Right through, nothing comes to the other side.
  const Cut through{{Vec3(15.5, -1, -1), Vec3(15.5, 31, -1)}, Vec3(0, 0, 2)};
  const Bound parted = bound(shape, node, 1, {through});
  for (Index v = 0; v < b.graph.size(); ++v)
    EXPECT_EQ(std::isfinite(parted.near.distance[v]), parted.graph.vertices[v].x() < 15.5);
}

TEST(SurfaceDistance, CanBeCancelled) {
  const Shape shape = sheet(130, flat);
  const std::vector<Vec3> nodes = nodes_on(shape, 100);
  const NeighbourGraph graph = surface_graph(shape, places_of(shape.positions), nodes, 5, {});
  EXPECT_EQ(nearest_along_surface(graph, nodes, 5, {}, [](double) { return false; }).width, 0u);
  EXPECT_EQ(nearest_along_surface(graph, nodes, 5, {}, [](double) { return true; }).width, 5u);
}

}  // namespace sinew
