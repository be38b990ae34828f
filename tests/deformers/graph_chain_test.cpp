/// A graph along the path of a particle: edges join each node to the next and to no other.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "deformers/graph.h"
#include "engine/geometry/skin.h"

namespace sinew {

namespace {

/// 12 nodes along x, one apart, and around each a ring of points of radius 0.4.
std::shared_ptr<const Shape> straight_stream(double bend = 0) {
  auto shape = std::make_shared<Shape>();
  for (int j = 0; j < 12; ++j) shape->positions.emplace_back(j, bend * j * j, 0);
  for (int j = 0; j < 12; ++j)
    for (int k = 0; k < 8; ++k) {
      const double angle = 0.785398163397448 * k;
      shape->positions.emplace_back(j, bend * j * j + 0.4 * std::cos(angle), 0.4 * std::sin(angle));
    }
  return shape;
}

GraphOptions chain() {
  GraphOptions options;
  for (Index j = 0; j < 12; ++j) options.given.push_back(j);
  options.chain = true;
  options.neighbours = 3;
  return options;
}

/// Holds the first node's ring, and lifts the ring of node 6.
Constraints lifted(const Shape& shape, const Vec3& by) {
  Constraints out;
  Handle handle;
  for (Index k = 0; k < 8; ++k) {
    out.fixed.push_back(12 + k);
    handle.points.push_back(12 + 6 * 8 + k);
    handle.targets.push_back(shape.positions[12 + 6 * 8 + k] + by);
  }
  out.handles = {handle};
  return out;
}

}  // namespace

TEST(GraphChain, EdgesJoinEachNodeToTheNext) {
  const auto deformer = make_graph_deformer(straight_stream(), chain());
  const Deformer::Structure structure = deformer->structure();
  ASSERT_EQ(structure.vertices.size(), 12u);
  ASSERT_EQ(structure.edges.size(), 11u);
  for (Index j = 0; j < 11; ++j) EXPECT_EQ(structure.edges[j], std::pair(j, j + 1));
  // Influence alone would join more.
  GraphOptions free = chain();
  free.chain = false;
  EXPECT_GT(make_graph_deformer(straight_stream(), free)->structure().edges.size(), 11u);
}

TEST(GraphChain, AStraightChainIsNotTwisted) {
  const auto shape = straight_stream();
  const auto deformer = make_graph_deformer(shape, chain());
  const SolveReport report = deformer->solve(lifted(*shape, Vec3(0, 1.5, 0)), {});
  EXPECT_EQ(report.status, Status::Converged) << report.message;
  // All happens in the plane of the lift: nothing turns about the chain, and the rings stay rings.
  const Shape bent = skin(*shape, deformer->weights(), deformer->pose());
  for (Index j = 0; j < 12; ++j) {
    const Mat3 A = deformer->pose()[j].leftCols<3>();
    EXPECT_LT(std::abs(A(2, 0)) + std::abs(A(2, 1)) + std::abs(A(0, 2)) + std::abs(A(1, 2)), 1e-3) << j;
    EXPECT_NEAR(A(2, 2), 1, 0.05) << j;
    for (Index k = 0; k < 4; ++k) {
      const double width = (bent.positions[12 + 8 * j + k] - bent.positions[12 + 8 * j + k + 4]).norm();
      EXPECT_NEAR(width, 0.8, 0.16) << j << " " << k;
    }
  }
}

TEST(GraphChain, ACurvedChainFollowsAPullToTheSide) {
  const auto shape = straight_stream(0.05);
  const auto deformer = make_graph_deformer(shape, chain());
  const SolveReport report = deformer->solve(lifted(*shape, Vec3(0, 0, 2)), {});
  EXPECT_EQ(report.status, Status::Converged) << report.message;
  EXPECT_LT(report.handle_max, 0.02);
  const Shape bent = skin(*shape, deformer->weights(), deformer->pose());
  EXPECT_GT(bent.positions[11].z(), 1.5) << "what lies behind the handle goes along";
}

}  // namespace sinew
