#include "deformers/graph_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "engine/geometry/random.h"

namespace sinew {

namespace {

using Vec3 = Eigen::Vector3d;

std::vector<Vec3> random_points(std::size_t n, std::uint64_t seed) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < n; ++i)
    points.emplace_back(random_unit(seed, 3 * i), random_unit(seed, 3 * i + 1), random_unit(seed, 3 * i + 2));
  return points;
}

double row_sum(const SkinWeights& w, std::size_t i) {
  double sum = 0;
  for (std::uint64_t e = w.offsets[i]; e < w.offsets[i + 1]; ++e) sum += w.weights[e];
  return sum;
}

}  // namespace

TEST(GraphWeights, FollowEquation4) {
  const std::vector<Vec3> nodes = random_points(40, 1), points = random_points(300, 2);
  const SkinWeights w = node_weights(NearestTree(nodes), 4, points, Gradients::No);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<std::pair<double, std::uint32_t>> near;
    for (std::uint32_t j = 0; j < nodes.size(); ++j) near.emplace_back((points[i] - nodes[j]).norm(), j);
    std::sort(near.begin(), near.end());
    double sum = 0;
    for (int n = 0; n < 4; ++n) sum += std::pow(1 - near[n].first / near[4].first, 2);
    ASSERT_EQ(w.offsets[i + 1] - w.offsets[i], 4u);
    for (std::size_t n = 0; n < 4; ++n) {
      EXPECT_EQ(w.maps[w.offsets[i] + n], near[n].second);
      EXPECT_NEAR(w.weights[w.offsets[i] + n], std::pow(1 - near[n].first / near[4].first, 2) / sum, 1e-6);
    }
  }
}

TEST(GraphWeights, EquidistantNodesShareEqually) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  const std::vector<Vec3> centre = {Vec3(0.5, 0.5, 0.5)};
  for (const int k : {1, 4, 7}) {
    const SkinWeights w = node_weights(NearestTree(corners), k, centre, Gradients::No);
    ASSERT_EQ(w.influences(), static_cast<std::size_t>(k));
    for (const float x : w.weights) EXPECT_NEAR(x, 1.0 / k, 1e-7);
  }
}

TEST(GraphWeights, ANodeAsFarAsTheNextHasNoInfluenceAndMakesNoEdge) {
  // Distances 1, 2, 2: the second and third node tie at d_max, so only the first counts.
  const std::vector<Vec3> nodes = {Vec3(1, 0, 0), Vec3(0, 2, 0), Vec3(0, -2, 0)};
  const std::vector<Vec3> origin = {Vec3::Zero()};
  const SkinWeights w = node_weights(NearestTree(nodes), 2, origin, Gradients::No);
  ASSERT_EQ(w.influences(), 1u);
  EXPECT_EQ(w.maps[0], 0u);
  EXPECT_FLOAT_EQ(w.weights[0], 1);
  EXPECT_TRUE(influence_edges(w, 3).empty());
}

TEST(GraphWeights, FewNodesManyNodesAndPointsThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3> points = {Vec3(0, 0, 0), Vec3(nan, 0, 0), Vec3(9, 9, 9), Vec3(0, HUGE_VAL, 0)};
  for (const std::size_t m : {1u, 2u, 3u, 5u, 50u}) {
    const SkinWeights w = node_weights(NearestTree(random_points(m, m)), 4, points, Gradients::No);
    ASSERT_EQ(w.size(), 4u);
    EXPECT_NEAR(row_sum(w, 0), 1, 1e-6) << m;
    EXPECT_NEAR(row_sum(w, 2), 1, 1e-6) << m;
    EXPECT_EQ(w.offsets[2] - w.offsets[1], 0u);
    EXPECT_EQ(w.offsets[4] - w.offsets[3], 0u);
    for (const float x : w.weights) EXPECT_TRUE(std::isfinite(x));
  }
  EXPECT_EQ(node_weights(NearestTree(std::vector<Vec3>{}), 4, points, Gradients::No).influences(), 0u);
  // All nodes at one place, and the point there too.
  const SkinWeights same = node_weights(NearestTree(std::vector<Vec3>(6, Vec3::Zero())), 4, points, Gradients::No);
  EXPECT_NEAR(row_sum(same, 0), 1, 1e-6);
}

TEST(GraphWeights, EdgesJoinExactlyTheNodesThatShareAPoint) {
  const std::vector<Vec3> nodes = random_points(60, 3), points = random_points(200, 4);
  const SkinWeights w = node_weights(NearestTree(nodes), 4, points, Gradients::No);
  std::set<std::pair<std::uint32_t, std::uint32_t>> expected;
  for (std::size_t i = 0; i < w.size(); ++i)
    for (std::uint64_t a = w.offsets[i]; a < w.offsets[i + 1]; ++a)
      for (std::uint64_t b = w.offsets[i]; b < w.offsets[i + 1]; ++b)
        if (w.maps[a] < w.maps[b]) expected.emplace(w.maps[a], w.maps[b]);
  const auto edges = influence_edges(w, nodes.size());
  EXPECT_TRUE(std::equal(edges.begin(), edges.end(), expected.begin(), expected.end()));
  // The two ways of remembering pairs agree.
  const auto sparse = influence_edges(w, 20000);
  EXPECT_EQ(edges, sparse);
}

TEST(GraphWeights, GradientsAreThoseOfCentralDifferences) {
  const std::vector<Vec3> nodes = random_points(40, 7), points = random_points(100, 8);
  const NearestTree tree(nodes);
  const SkinWeights w = node_weights(tree, 4, points, Gradients::Yes);
  ASSERT_EQ(w.gradients.size(), w.influences());
  constexpr double h = 1e-6;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const Vec3 step = h * Vec3::Unit(c);
      const std::vector<Vec3> around = {points[i] - step, points[i] + step};
      const auto exact = [&](const Vec3& p, std::uint32_t map) {  // eq. 4 in double
        std::vector<double> d;
        for (const Vec3& g : nodes) d.push_back((g - p).norm());
        std::vector<double> sorted = d;
        std::nth_element(sorted.begin(), sorted.begin() + 4, sorted.end());
        const double d_max = sorted[4];
        double sum = 0;
        for (const double x : d) sum += x < d_max ? (1 - x / d_max) * (1 - x / d_max) : 0;
        return d[map] < d_max ? (1 - d[map] / d_max) * (1 - d[map] / d_max) / sum : 0;
      };
      for (std::uint64_t e = w.offsets[i]; e < w.offsets[i + 1]; ++e) {
        const double slope = (exact(around[1], w.maps[e]) - exact(around[0], w.maps[e])) / (2 * h);
        EXPECT_NEAR(static_cast<double>(w.gradients[e][c]), slope, 1e-4 * (1 + std::abs(slope)));
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 600u);
}

TEST(GraphWeights, CanBeCancelled) {
  const std::vector<Vec3> points = random_points(70000, 5);
  int calls = 0;
  const SkinWeights w =
      node_weights(NearestTree(random_points(10, 6)), 4, points, Gradients::No, [&](double) { return ++calls < 2; });
  EXPECT_EQ(w.size(), 0u);
  EXPECT_EQ(calls, 2);
}

}  // namespace sinew
