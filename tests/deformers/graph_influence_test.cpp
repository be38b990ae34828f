#include "deformers/graph_influence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "deformers/graph.h"
#include "deformers/graph_weights.h"
#include "engine/geometry/error.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/random.h"
#include "engine/geometry/skin.h"

namespace sinew {

namespace {

constexpr Index side = 24;

/// Appends a sheet of side x side points, 1/24 apart, and its faces.
void add_sheet(Shape& shape, const Vec3& corner, const Vec3& u, const Vec3& v, bool faces, Index width = side) {
  const auto first = static_cast<Index>(shape.size());
  for (Index y = 0; y < side; ++y)
    for (Index x = 0; x < width; ++x) shape.positions.emplace_back(corner + (x * u + y * v) / side);
  for (Index y = 0; faces && y + 1 < side; ++y)
    for (Index x = 0; x + 1 < width; ++x) {
      const Index i = first + y * width + x;
      shape.faces.add(std::vector<Index>{i, i + 1, i + width + 1, i + width});
    }
}

/// Two sheets that lie on each other: points 0 .. side^2 - 1 below, the others above.
Shape two_sheets(bool faces) {
  Shape shape;
  add_sheet(shape, Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), faces);
  add_sheet(shape, Vec3(0.01, 0, 0.03), Vec3(1, 0, 0), Vec3(0, 1, 0), faces);
  return shape;
}

Cut between_sheets() {
  return {{Vec3(-1, -1, 0.015), Vec3(2, -1, 0.015)}, Vec3(0, 3, 0)};
}

/// A hand on a leg: one strip, folded over so that its second half lies just above the first.
Shape folded() {
  Shape shape;
  const Index length = 3 * side;
  for (Index y = 0; y < side; ++y)
    for (Index x = 0; x < length; ++x) {
      const double s = static_cast<double>(x) / side, v = static_cast<double>(y) / side;
      const double turn = std::clamp((s - 1.45) / 0.1, 0.0, 1.0) * M_PI;  // half a circle of radius 0.1 / pi
      const double r = 0.1 / M_PI;
      const double along = s <= 1.45 ? s : s >= 1.55 ? 1.45 - (s - 1.55) : 1.45 + r * std::sin(turn);
      shape.positions.emplace_back(along, v, r * (1 - std::cos(turn)));
    }
  for (Index y = 0; y + 1 < side; ++y)
    for (Index x = 0; x + 1 < length; ++x) {
      const Index i = y * length + x;
      shape.faces.add(std::vector<Index>{i, i + 1, i + length + 1, i + length});
    }
  return shape;
}

GraphOptions options_of(bool surface, std::vector<Cut> cuts = {}, int nodes = 60) {
  GraphOptions options;
  options.nodes = nodes;
  options.surface = surface;
  options.cuts = std::move(cuts);
  return options;
}

std::unique_ptr<Deformer> deformer_of(const Shape& shape, const GraphOptions& options) {
  return make_graph_deformer(std::make_shared<Shape>(shape), options);
}

std::vector<Vec3> bent(const Deformer& deformer, const Shape& rest) {
  return skin(rest, deformer.weights(), deformer.pose()).positions;
}

Constraints moved(const Shape& shape, const std::vector<Index>& points, const Vec3& by) {
  Constraints c;
  c.handles.emplace_back();
  for (const Index i : points) {
    c.handles[0].points.push_back(i);
    c.handles[0].targets.push_back(shape.positions[i] + by);
  }
  return c;
}

/// How far the points [first, last) went at most, the handles lifted by 0.3 with those at `fixed` held.
double pulled(const Shape& shape, const GraphOptions& options, const std::vector<Index>& handles, Index first,
              Index last, const std::vector<Index>& fixed = {}) {
  const auto deformer = deformer_of(shape, options);
  Constraints c = moved(shape, handles, Vec3(0, 0, 0.3));
  c.fixed = fixed;
  EXPECT_EQ(deformer->solve(c, {}).status, Status::Converged);
  const std::vector<Vec3> after = bent(*deformer, shape);
  double most = 0;
  for (Index i = first; i < last; ++i) most = std::max(most, (after[i] - shape.positions[i]).norm());
  return most;
}

void expect_sound_rows(const SkinWeights& weights, std::size_t points) {
  ASSERT_EQ(weights.size(), points);
  for (std::size_t i = 0; i < points; ++i) {
    double sum = 0;
    for (std::uint64_t e = weights.offsets[i]; e < weights.offsets[i + 1]; ++e)
      sum += static_cast<double>(weights.weights[e]);
    ASSERT_NEAR(sum, 1, 1e-6) << i;
  }
}

}  // namespace

TEST(GraphInfluence, ACutFreesWhatLiesOnSomethingElse) {
  constexpr Index n = side * side;
  const std::vector<Index> handles = {n + 5, n + 300, n + 560};
  for (const bool surface : {false, true})
    for (const bool faces : {false, true}) {
      const Shape shape = two_sheets(faces);
      EXPECT_EQ(pulled(shape, options_of(surface, {between_sheets()}), handles, 0, n), 0) << surface << faces;
      // The cut is what does it: without, or elsewhere, the lower sheet follows.
      EXPECT_GT(pulled(shape, options_of(surface), handles, 0, n), 0.2) << surface << faces;
      Cut elsewhere = between_sheets();
      for (Vec3& p : elsewhere.path) p.z() = 0.5;
      EXPECT_GT(pulled(shape, options_of(surface, {elsewhere}), handles, 0, n), 0.2) << surface << faces;
    }
}

TEST(GraphInfluence, AHandOnALegIsNotJoinedAlongTheSurface) {
  const Shape shape = folded();
  // The free end is lifted off what it lies on; the other end and the fold are held.
  std::vector<Index> handles, fixed;
  for (Index y = 0; y < side; ++y) {
    handles.push_back(y * 3 * side + 3 * side - 1);
    for (Index x = 30; x < 42; ++x) fixed.push_back(y * 3 * side + x);
  }
  const auto most_of_lower = [&](const GraphOptions& options) {
    const auto deformer = deformer_of(shape, options);
    Constraints c = moved(shape, handles, Vec3(0, 0, 0.2));
    c.fixed = fixed;
    deformer->solve(c, {});
    const std::vector<Vec3> after = bent(*deformer, shape);
    double most = 0;
    for (Index y = 0; y < side; ++y)
      for (Index x = 0; x < 24; ++x)
        most = std::max(most, (after[y * 3 * side + x] - shape.positions[y * 3 * side + x]).norm());
    return most;
  };
  EXPECT_LT(most_of_lower(options_of(true, {}, 150)), 1e-3);
  EXPECT_GT(most_of_lower(options_of(false, {}, 150)), 0.05);
}

TEST(GraphInfluence, PartsFollowAcrossSmallGaps) {
  // A seat, four legs a hair below it, and a label far above that has no node of its own.
  Shape chair;
  add_sheet(chair, Vec3(0, 0, 0.5), Vec3(1, 0, 0), Vec3(0, 1, 0), true);
  const auto legs = static_cast<Index>(chair.size());
  for (const double x : {0.05, 0.85})
    for (const double y : {0.05, 0.85}) add_sheet(chair, Vec3(x, y, 0.0), Vec3(1, 0, 0), Vec3(0, 0, 0.52), true, 3);
  const auto label = static_cast<Index>(chair.size());
  for (int i = 0; i < 3; ++i) chair.positions.emplace_back(0.5 + 1e-4 * i, 0.5 + 1e-4 * (i % 2), 1.1);
  chair.faces.add(std::vector<Index>{label, label + 1, label + 2});
  const auto deformer = deformer_of(chair, options_of(true));
  EXPECT_TRUE(deformer->notes().empty());
  deformer->solve(moved(chair, {5, 200, 570}, Vec3(0.2, 0.1, 0.3)), {});
  const std::vector<Vec3> after = bent(*deformer, chair);
  for (Index i = legs; i < chair.size(); ++i) EXPECT_GT((after[i] - chair.positions[i]).norm(), 0.1) << i;
}

TEST(GraphInfluence, ABoxOfEightPointsHangsTogether) {
  Shape box;
  for (int i = 0; i < 8; ++i) box.positions.emplace_back(i & 1, i >> 1 & 1, 3 * (i >> 2));
  for (const auto& face : std::vector<std::vector<Index>>{
           {0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}})
    box.faces.add(face);
  for (const bool surface : {false, true}) {
    const auto deformer = deformer_of(box, options_of(surface, {}, 250));
    deformer->solve(moved(box, {3}, Vec3(1, 2, 3)), {});
    const std::vector<Vec3> after = bent(*deformer, box);
    for (std::size_t i = 0; i < 8; ++i)
      EXPECT_LT((after[i] - box.positions[i] - Vec3(1, 2, 3)).norm(), 0.01) << surface << i;
  }
}

TEST(GraphInfluence, AnIslandThatReachesNoNodeFollowsAndIsCounted) {
  Shape shape = two_sheets(true);
  for (int i = 0; i < 3; ++i) shape.positions.emplace_back(0.5 + 0.01 * i, 0.5 + 0.01 * (i % 2), 0.3);
  const auto first = static_cast<Index>(shape.size() - 3);
  shape.faces.add(std::vector<Index>{first, first + 1, first + 2});
  GraphOptions options = options_of(true);
  for (Index i = 0; i < 2 * side * side; i += 20) options.given.push_back(i);
  EXPECT_TRUE(deformer_of(shape, options)->notes().empty());
  // A box of curtains around the island.
  const double z = 0.2;
  options.cuts = {{{Vec3(0.4, 0.4, z), Vec3(0.6, 0.4, z), Vec3(0.6, 0.6, z), Vec3(0.4, 0.6, z), Vec3(0.4, 0.4, z)},
                   Vec3(0, 0, 0.2)},
                  {{Vec3(0.4, 0.4, z), Vec3(0.6, 0.4, z)}, Vec3(0, 0.2, 0)},
                  {{Vec3(0.4, 0.4, 0.4), Vec3(0.6, 0.4, 0.4)}, Vec3(0, 0.2, 0)}};
  for (const bool surface : {true, false}) {
    options.surface = surface;
    const auto deformer = deformer_of(shape, options);
    ASSERT_EQ(deformer->notes().size(), 1u);
    EXPECT_EQ(deformer->notes()[0].substr(0, 9), "3 points ") << deformer->notes()[0];
    expect_sound_rows(deformer->weights(), shape.size());
  }
}

TEST(GraphInfluence, StraightWeightsWithACutAreThoseOfTheNodesOnOneSide) {
  const Shape shape = two_sheets(false);
  const auto deformer = deformer_of(shape, options_of(false, {between_sheets()}));
  const std::vector<Vec3> nodes = deformer->structure().vertices;
  for (const bool above : {false, true}) {
    std::vector<Vec3> own, points;
    std::vector<Index> index;
    for (Index j = 0; j < nodes.size(); ++j)
      if ((nodes[j].z() > 0.015) == above) {
        own.push_back(nodes[j]);
        index.push_back(j);
      }
    constexpr Index n = side * side;
    const std::size_t first = above ? n : 0;
    points.assign(shape.positions.begin() + static_cast<std::ptrdiff_t>(first),
                  shape.positions.begin() + static_cast<std::ptrdiff_t>(first + n));
    const SkinWeights expected = node_weights(NearestTree(own), 4, points, Gradients::No);
    const SkinWeights& found = deformer->weights();
    for (std::size_t i = 0; i < n; ++i) {
      ASSERT_EQ(found.offsets[first + i + 1] - found.offsets[first + i], expected.offsets[i + 1] - expected.offsets[i]);
      for (std::uint64_t e = 0; e < expected.offsets[i + 1] - expected.offsets[i]; ++e) {
        EXPECT_EQ(found.maps[found.offsets[first + i] + e], index[expected.maps[expected.offsets[i] + e]]);
        EXPECT_EQ(found.weights[found.offsets[first + i] + e], expected.weights[expected.offsets[i] + e]);
      }
    }
  }
}

TEST(GraphInfluence, OtherPointsAreBoundAsTheShapeIs) {
  const Shape shape = two_sheets(true);
  std::vector<Vec3> others;
  for (std::uint64_t i = 0; i < 500; ++i)
    others.emplace_back(random_unit(1, i), random_unit(2, i), i % 2 == 0 ? 0.002 : 0.028);
  const Method method = graph_method();
  for (const bool surface : {false, true})
    for (const std::vector<Cut>& cuts : {std::vector<Cut>{}, {between_sheets()}}) {
      const auto deformer = deformer_of(shape, options_of(surface, cuts));
      const SkinWeights& own = deformer->weights();
      expect_sound_rows(own, shape.size());
      // The shape's own points have their own rows, from the deformer and from the tables.
      for (const SkinWeights& again : {deformer->bind(shape.positions, Gradients::No),
                                       method.bind(deformer->binding(), shape.positions, Gradients::No)}) {
        EXPECT_EQ(again.offsets, own.offsets);
        EXPECT_EQ(again.maps, own.maps);
        EXPECT_EQ(again.weights, own.weights);
      }
      const SkinWeights bound = method.bind(deformer->binding(), others, Gradients::Yes);
      expect_sound_rows(bound, others.size());
      EXPECT_EQ(bound.gradients.size(), surface ? 0 : bound.influences());
      // Near the shape, what moves the others is what moves their neighbours.
      deformer->solve(moved(shape, {580, 900, 1140}, Vec3(0, 0, 0.3)), {});
      std::vector<Vec3> went(others.size());
      skin_points(bound, deformer->pose(), others, went);
      const std::vector<Vec3> after = bent(*deformer, shape);
      for (std::size_t i = 0; i < others.size(); ++i) {
        std::vector<Index> near(1);
        std::vector<double> distance(1);
        const std::size_t first = i % 2 == 0 ? 0 : side * side;
        NearestTree(std::span(shape.positions).subspan(first, side * side)).nearest({&others[i], 1}, 1, near, distance);
        const std::size_t k = first + near[0];
        EXPECT_LT((went[i] - others[i] - after[k] + shape.positions[k]).norm(), 0.03);
        if (!cuts.empty() && i % 2 == 0) {
          EXPECT_EQ(went[i], others[i]);
        }
      }
    }
}

TEST(GraphInfluence, AWeightOfOtherPointsIsContinuous) {
  const Shape shape = folded();
  const auto deformer = deformer_of(shape, options_of(true, {}, 100));
  std::vector<Vec3> line;
  for (int i = 0; i <= 20000; ++i) line.emplace_back(0.1 + 5e-5 * i, 0.4 + 1e-5 * i, 0.003);
  const SkinWeights bound = deformer->bind(line, Gradients::No);
  std::vector<float> last(100, 0), now;
  for (std::size_t i = 0; i < line.size(); ++i) {
    now.assign(100, 0);
    for (std::uint64_t e = bound.offsets[i]; e < bound.offsets[i + 1]; ++e) now[bound.maps[e]] = bound.weights[e];
    for (std::size_t j = 0; i > 0 && j < 100; ++j) ASSERT_NEAR(now[j], last[j], 0.01) << i;
    last = now;
  }
}

TEST(GraphInfluence, TablesThatAreWrongAreRefused) {
  const Shape shape = two_sheets(true);
  const auto deformer = deformer_of(shape, options_of(true, {between_sheets()}));
  const std::vector<Deformer::Table> good = deformer->binding();
  const auto refused = [&](const std::function<void(std::vector<Deformer::Table>&)>& spoil) {
    std::vector<Deformer::Table> tables = good;
    spoil(tables);
    EXPECT_THROW(GraphInfluence::from_tables(tables), InputError);
  };
  const auto named = [](std::vector<Deformer::Table>& tables, const std::string& name) -> Deformer::Table& {
    return *std::find_if(tables.begin(), tables.end(), [&](const auto& table) { return table.name == name; });
  };
  EXPECT_NO_THROW(GraphInfluence::from_tables(good));
  for (const char* name : {"nodes", "neighbours", "cut_lengths", "points_rows", "points_influences"}) {
    refused([&](auto& tables) { std::erase_if(tables, [&](const auto& table) { return table.name == name; }); });
    refused([&](auto& tables) { named(tables, name).values[0] = std::nan(""); });
    if (std::string(name) != "nodes") refused([&](auto& tables) { named(tables, name).values[0] = 1e300; });
    refused([&](auto& tables) { named(tables, name).values.pop_back(); });
  }
  refused([&](auto& tables) { named(tables, "cuts").values[2] = HUGE_VAL; });
  refused([&](auto& tables) { named(tables, "points").values.resize(300); });
  refused([&](auto& tables) { named(tables, "points").values[7] = std::nan(""); });
  refused([&](auto& tables) { named(tables, "points_influences").values[1] = -0.5; });
}

TEST(GraphInfluence, IsTheSameForAnyNumberOfThreadsAndInAnyUnit) {
  const Shape shape = two_sheets(true);
  const auto deformer = deformer_of(shape, options_of(true));
  for (const int threads : {1, 7}) {
    set_thread_count(threads);
    const auto other = deformer_of(shape, options_of(true));
    EXPECT_EQ(other->weights().maps, deformer->weights().maps);
    EXPECT_EQ(other->weights().weights, deformer->weights().weights);
  }
  set_thread_count(2);
  Shape large = shape;
  for (Vec3& p : large.positions) p *= 1024;  // a power of two: the same bits
  const auto other = deformer_of(large, options_of(true));
  EXPECT_EQ(other->weights().maps, deformer->weights().maps);
  EXPECT_EQ(other->weights().weights, deformer->weights().weights);
}

TEST(GraphInfluence, FollowsAnotherFrame) {
  const Shape shape = two_sheets(true);
  Shape later = shape;
  for (Vec3& p : later.positions) p += Vec3(5, 0, 0.5 * p.x());
  const auto deformer = deformer_of(shape, options_of(true, {between_sheets()}));
  const SkinWeights before = deformer->weights();
  deformer->follow(std::make_shared<Shape>(later));
  const SkinWeights bound = deformer->bind(later.positions, Gradients::No);
  EXPECT_EQ(bound.maps, before.maps);
  EXPECT_EQ(bound.weights, before.weights);
  // The way there leaves no trace.
  const auto straight = deformer_of(shape, options_of(true, {between_sheets()}));
  Shape between = later;
  for (Vec3& p : between.positions) p = Vec3(0.3 * p.z(), 1.7 * p.x(), p.y() / 3);
  deformer->follow(std::make_shared<Shape>(between));
  deformer->follow(std::make_shared<Shape>(later));
  straight->follow(std::make_shared<Shape>(later));
  const auto cuts = [](const Deformer& d) {
    for (const Deformer::Table& table : d.binding())
      if (table.name == "cuts") return table.values;
    return std::vector<double>{};
  };
  const std::vector<double> a = cuts(*deformer), b = cuts(*straight);
  EXPECT_FALSE(a.empty());
  EXPECT_EQ(a, b);
}

TEST(GraphInfluence, WhereItFollowsToDoesNotDependOnTheWay) {
  const Shape shape = two_sheets(true);
  const auto frame = [&shape](double time) {
    Shape out = shape;
    for (Vec3& p : out.positions) p += Vec3(0.1 * time, std::sin(time + p.x()) / 3, 0.7 * p.y());
    return std::make_shared<const Shape>(out);
  };
  const auto one = deformer_of(shape, options_of(true)), other = deformer_of(shape, options_of(true));
  const std::vector<Vec3> made = one->structure().vertices;
  one->follow(frame(9));
  for (int time = 1; time <= 9; ++time) other->follow(frame(time));
  EXPECT_EQ(one->structure().vertices, other->structure().vertices);
  other->follow(std::make_shared<Shape>(shape));
  EXPECT_EQ(other->structure().vertices, made);
  EXPECT_NE(one->structure().vertices, made);
}

}  // namespace sinew
