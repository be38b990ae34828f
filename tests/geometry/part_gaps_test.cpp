#include "engine/geometry/part_gaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "engine/geometry/random.h"

namespace sinew {

namespace {

/// Parts of points on lines along x, each at its own y, spacing 1.
struct Lines {
  std::vector<Vec3> points;
  GraphParts parts;

  void add(double y, int count, double x0 = 0) {
    for (int i = 0; i < count; ++i) {
      points.emplace_back(x0 + i, y, 0);
      parts.of_vertex.push_back(static_cast<Index>(parts.count));
    }
    ++parts.count;
  }

  /// Which pairs of parts the bridges join.
  std::set<std::pair<Index, Index>> joined(const BridgeWishes& wishes, const std::vector<Cut>& cuts = {}) const {
    std::set<std::pair<Index, Index>> out;
    for (const auto& [a, b] : bridges_between(points, parts, wishes, Curtains(cuts))) {
      EXPECT_NE(parts.of_vertex[a], parts.of_vertex[b]);
      out.insert(std::minmax(parts.of_vertex[a], parts.of_vertex[b]));
    }
    return out;
  }
};

using Pairs = std::set<std::pair<Index, Index>>;

BridgeWishes wishes_of(const std::vector<Index>& weight, double reach) {
  BridgeWishes wishes;
  wishes.reach = reach;
  wishes.spacing = 0.1;
  wishes.weight = weight;
  wishes.enough = 5;
  return wishes;
}

}  // namespace

TEST(PartGaps, EachPartIsJoinedToItsNearestWithinReach) {
  Lines lines;
  for (const double y : {0.0, 1.0, 3.0, 20.0}) lines.add(y, 10);
  const std::vector<Index> weight(4, 9);
  // 0-1 and 1-2, not 0-2, though that is within reach too; the last is too far.
  EXPECT_EQ(lines.joined(wishes_of(weight, 5)), (Pairs{{0, 1}, {1, 2}}));
  EXPECT_EQ(lines.joined(wishes_of(weight, 1.5)), (Pairs{{0, 1}}));
  EXPECT_EQ(lines.joined(wishes_of(weight, 0.5)), Pairs{});
}

TEST(PartGaps, APartWithoutEnoughIsJoinedHoweverFar) {
  Lines lines;
  for (const double y : {0.0, 100.0, 300.0}) lines.add(y, 10);
  EXPECT_EQ(lines.joined(wishes_of({9, 9, 0}, 1)), (Pairs{{1, 2}}));
  EXPECT_EQ(lines.joined(wishes_of({9, 4, 9}, 1)), (Pairs{{0, 1}}));
  // Two that together have enough need no third.
  EXPECT_EQ(lines.joined(wishes_of({2, 3, 9}, 1)), (Pairs{{0, 1}}));
  EXPECT_EQ(lines.joined(wishes_of({2, 2, 9}, 1)), (Pairs{{0, 1}, {1, 2}}));
}

TEST(PartGaps, TouchingPartsAreJoinedAllAlongAndWithEachOther) {
  Lines lines;
  for (const double y : {0.0, 1e-7, 2e-7}) lines.add(y, 10);
  const std::vector<Index> weight(3, 9);
  BridgeWishes wishes = wishes_of(weight, 0);
  wishes.touch = 1e-6;
  EXPECT_GE(bridges_between(lines.points, lines.parts, wishes, {}).size(), 30u);
  wishes.touch = 1e-8;
  EXPECT_TRUE(bridges_between(lines.points, lines.parts, wishes, {}).empty());
}

TEST(PartGaps, AJoinIsAsWideAsTheContact) {
  Lines lines;
  lines.add(0, 10);
  lines.add(0.3, 10, 0.05);
  lines.points.back().y() = 5;  // one end bends away
  const std::vector<Index> weight(2, 9);
  std::set<Index> bridged;
  for (const auto& [a, b] : bridges_between(lines.points, lines.parts, wishes_of(weight, 1), {}))
    bridged.insert(std::max(a, b));
  EXPECT_EQ(bridged.size(), 9u);
  EXPECT_FALSE(bridged.contains(19));
}

TEST(PartGaps, NoBridgeCrossesACurtain) {
  Lines lines;
  lines.add(0, 10);
  lines.add(1, 10);
  const std::vector<Index> weight(2, 9);
  const Cut between{{Vec3(-1, 0.5, -1), Vec3(20, 0.5, -1)}, Vec3(0, 0, 2)};
  EXPECT_EQ(lines.joined(wishes_of(weight, 2), {between}), Pairs{});
  // One that leaves the last points free: joined there alone.
  const Cut shorter{{Vec3(-1, 0.5, -1), Vec3(8.5, 0.5, -1)}, Vec3(0, 0, 2)};
  const Edges edges = bridges_between(lines.points, lines.parts, wishes_of(weight, 2), Curtains(std::vector{shorter}));
  ASSERT_FALSE(edges.empty());
  for (const auto& [a, b] : edges) EXPECT_GT(lines.points[a].x() + lines.points[b].x(), 17);
}

TEST(PartGaps, TheShortestGapsOfRandomParts) {
  // Against Kruskal's algorithm over all pairs: the bridges' sum of gaps is that of the minimum spanning tree.
  Lines lines;
  for (std::uint64_t part = 0; part < 40; ++part) {
    const Vec3 centre(10 * random_unit(1, part), 10 * random_unit(2, part), 10 * random_unit(3, part));
    for (std::uint64_t i = 0; i < 25; ++i) {
      lines.points.push_back(
          centre + Vec3(random_unit(4, 25 * part + i), random_unit(5, 25 * part + i), random_unit(6, 25 * part + i)));
      lines.parts.of_vertex.push_back(static_cast<Index>(part));
    }
    ++lines.parts.count;
  }
  std::vector<std::tuple<double, Index, Index>> pairs;
  for (Index a = 0; a < lines.points.size(); ++a)
    for (Index b = a + 1; b < lines.points.size(); ++b)
      if (lines.parts.of_vertex[a] != lines.parts.of_vertex[b])
        pairs.emplace_back((lines.points[a] - lines.points[b]).norm(), lines.parts.of_vertex[a],
                           lines.parts.of_vertex[b]);
  std::sort(pairs.begin(), pairs.end());
  std::vector<Index> set(40);
  for (Index i = 0; i < 40; ++i) set[i] = i;
  Pairs expected;
  for (const auto& [gap, a, b] : pairs) {
    const Index from = set[b], to = set[a];
    if (from == to) continue;
    expected.insert(std::minmax(a, b));
    std::replace(set.begin(), set.end(), from, to);
  }
  EXPECT_EQ(expected.size(), 39u);
  const std::vector<Index> weight(40, 0);
  BridgeWishes wishes = wishes_of(weight, 0);
  wishes.enough = 1;
  EXPECT_EQ(lines.joined(wishes), expected);
}

}  // namespace sinew
