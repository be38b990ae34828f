#include "deformers/shell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "engine/geometry/affine.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/error.h"
#include "engine/geometry/random.h"
#include "engine/geometry/topology.h"
#include "tests/deformers/shell_shapes.h"

namespace sinew {
namespace {

using test::Bend;
using test::bent;
using test::distance;
using test::small_cylinder;

std::unique_ptr<Deformer> shell(std::shared_ptr<const Shape> rest,
                                std::vector<std::shared_ptr<const Shape>> examples = {}, ShellOptions options = {}) {
  return make_shell_deformer(std::move(rest), examples, options);
}

std::vector<Vec3> solved(const std::shared_ptr<const Shape>& rest, const Constraints& constraints,
                         std::vector<std::shared_ptr<const Shape>> examples = {}, ShellOptions options = {}) {
  const auto deformer = shell(rest, std::move(examples), options);
  const SolveReport report = deformer->solve(constraints, {});
  EXPECT_EQ(report.status, Status::Converged) << report.message;
  return bent(*rest, *deformer);
}

Constraints weights(std::vector<std::optional<double>> values) {
  Constraints out;
  out.example_weights = std::move(values);
  return out;
}

double volume_change(const Shape& rest, std::span<const Vec3> x) {
  return quality_of(rest, x).volume_change;
}

TEST(Shell, HoldsFixedPointsAndHandlesExactlyAndBendsWhatIsBetween) {
  const auto rest = small_cylinder();
  const Bend bend{120, 0.3, 0.5};
  const Constraints constraints = test::moved_end(*rest, bend);
  const std::vector<Vec3> x = solved(rest, constraints);
  for (const Index i : constraints.fixed) ASSERT_EQ(x[i], rest->positions[i]);
  const Handle& handle = constraints.handles[0];
  for (std::size_t k = 0; k < handle.points.size(); ++k)
    ASSERT_LT((x[handle.points[k]] - handle.targets[k]).norm(), 1e-12);
  const Quality quality = quality_of(*rest, x);
  EXPECT_LT(quality.edge_rms, 0.03);
}

TEST(Shell, ARigidMotionOfTheHandlesIsFollowedExactly) {
  const auto rest = small_cylinder();
  const Mat3 R = Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const auto motion = [&](const Vec3& p) { return Vec3(R * p + Vec3(0.2, -0.3, 0.1)); };
  Constraints constraints = test::moved_end(*rest, motion);
  constraints.handles.push_back({constraints.fixed, {}});
  for (const Index i : std::exchange(constraints.fixed, {}))
    constraints.handles[1].targets.push_back(motion(rest->positions[i]));
  const std::vector<Vec3> x = solved(rest, constraints);
  for (std::size_t i = 0; i < x.size(); ++i) ASSERT_LT((x[i] - motion(rest->positions[i])).norm(), 1e-6);
}

TEST(Shell, TheResultTurnsWithTheInputAndScalesWithIt) {
  const auto rest = small_cylinder();
  const auto example = test::mapped(*rest, Bend{60, 0.3, 0.5});
  const Bend bend{80, 0.2, 0.7};
  const Mat3 R = Eigen::AngleAxisd(2.1, Vec3(-1, 2, 0.5).normalized()).toRotationMatrix();
  const auto turn = [&](const Vec3& p) { return Vec3(1000 * (R * p) + Vec3(300, -200, 500)); };
  const std::vector<Vec3> x = solved(rest, test::moved_end(*rest, bend), {example});
  const auto turned = test::mapped(*rest, turn);
  Constraints constraints = test::moved_end(*rest, bend);
  for (Vec3& p : constraints.handles[0].targets) p = turn(p);
  // The example in another place again: nothing depends on where it stands.
  const auto turned_example = test::mapped(*example, [&](const Vec3& p) { return Vec3(1000 * (R.transpose() * p)); });
  const std::vector<Vec3> y = solved(turned, constraints, {turned_example});
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) worst = std::max(worst, (y[i] - turn(x[i])).norm());
  EXPECT_LT(worst / 1000, 1e-6);
}

TEST(Shell, TurnsAndScalesToRoundingWhereTheMinimumIsReached) {
  // A bend so slight that nothing buckles: there is one minimum, and it is reached to rounding.
  const auto rest = small_cylinder();
  const Bend bend{12, 0.2, 0.7};
  const Mat3 R = Eigen::AngleAxisd(2.1, Vec3(-1, 2, 0.5).normalized()).toRotationMatrix();
  const auto turn = [&](const Vec3& p) { return Vec3(1000 * (R * p)); };
  const auto turned = test::mapped(*rest, turn);
  SolveOptions options;
  options.epsilon = 1e-24;
  const auto a = shell(rest), b = shell(turned);
  Constraints constraints = test::moved_end(*rest, bend);
  a->solve(constraints, options);
  for (Vec3& p : constraints.handles[0].targets) p = turn(p);
  b->solve(constraints, options);
  const std::vector<Vec3> x = bent(*rest, *a), y = bent(*turned, *b);
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) worst = std::max(worst, (y[i] / 1000 - R * x[i]).norm());
  EXPECT_LT(worst, 1e-9);
}

TEST(Shell, InterpolatesFromRestThroughThePoseAndBeyond) {
  const auto rest = small_cylinder();
  const Bend full{90, 0.3, 0.5};
  const auto example = test::mapped(*rest, full);
  const std::vector<Vec3> at_rest = solved(rest, weights({0.0}), {example});
  EXPECT_LT(distance(at_rest, rest->positions), 1e-9);
  const std::vector<Vec3> at_pose = solved(rest, weights({1.0}), {example});
  EXPECT_LT(distance(at_pose, example->positions), 1e-6);
  for (const double w : {0.35, 0.65, 1.25}) {
    const std::vector<Vec3> x = solved(rest, weights({w}), {example});
    const auto wanted = test::mapped(*rest, Bend{90 * w, 0.3, 0.5});
    const Affine fit = rigid_fit(x, wanted->positions);
    std::vector<Vec3> laid = x;
    for (Vec3& p : laid) p = fit.leftCols<3>() * p + fit.col(3);
    EXPECT_LT(distance(laid, wanted->positions), 0.01) << w;
  }
}

TEST(Shell, ALargeTurnBetweenPosesIsInterpolatedTheLongWay) {
  // A ribbon and the same wound twice around an axis: halfway it is wound once.
  Shape ribbon;
  constexpr Index steps = 120, across = 4;
  for (Index i = 0; i <= steps; ++i)
    for (Index j = 0; j <= across; ++j) ribbon.positions.emplace_back(6.0 * i / steps, 0.3 * j / across, 0);
  for (Index i = 0; i < steps; ++i)
    for (Index j = 0; j < across; ++j) {
      const Index a = i * (across + 1) + j, b = a + across + 1;
      ribbon.faces.add(std::array{a, b, b + 1});
      ribbon.faces.add(std::array{a, b + 1, a + 1});
    }
  const auto wound = [](double turns) {
    return [turns](const Vec3& p) {
      const double r = 6 / (2 * M_PI * turns), a = p.x() / r;
      return Vec3(r * std::sin(a), p.y() + 0.15 * turns * p.x(), r * (1 - std::cos(a)));
    };
  };
  const auto rest = std::make_shared<const Shape>(ribbon);
  const auto example = test::mapped(ribbon, wound(2));
  const std::vector<Vec3> x = solved(rest, weights({0.5}), {example});
  // The winding: the turn of the ribbon's direction, added up.
  double turn = 0;
  Vec3 former;
  for (Index i = 0; i < steps; ++i) {
    const Vec3 along = (x[(i + 1) * (across + 1)] - x[i * (across + 1)]).normalized();
    if (i > 0) turn += std::acos(std::clamp(along.dot(former), -1.0, 1.0));
    former = along;
  }
  EXPECT_NEAR(turn / (2 * M_PI), 1, 0.15);
  EXPECT_LT(quality_of(ribbon, x).edge_rms, 0.1);
}

TEST(Shell, FindsTheWeightsOfAPoseThatHandlesAskFor) {
  const auto rest = small_cylinder();
  const auto left = test::mapped(*rest, Bend{70, 0.2, 0.35});
  const auto right = test::mapped(*rest, Bend{-60, 0.6, 0.35});
  const Bend some{35, 0.2, 0.35};
  Constraints constraints;
  Handle handle;
  for (Index i = 0; i < rest->size(); i += 7) {
    handle.points.push_back(i);
    handle.targets.push_back(some(rest->positions[i]));
  }
  constraints.handles.push_back(handle);
  const auto deformer = shell(rest, {left, right});
  const SolveReport report = deformer->solve(constraints, {});
  ASSERT_EQ(report.example_weights.size(), 2U);
  EXPECT_NEAR(report.example_weights[0], 0.5, 0.03);
  EXPECT_NEAR(report.example_weights[1], 0, 0.03);
  constraints.example_weights = {std::nullopt, 0.4};
  const SolveReport pinned = deformer->solve(constraints, {});
  EXPECT_EQ(pinned.example_weights[1], 0.4);
  EXPECT_GT(pinned.energy[0].second, report.energy[0].second);
}

TEST(Shell, ExamplesTeachWhatAHandleMeans) {
  // One example bends low and stays straight elsewhere. The top is dragged: with the example the bend is low.
  const auto rest = small_cylinder();
  const Bend low{80, 0.15, 0.2}, wanted{50, 0.15, 0.2};
  const Constraints constraints = test::moved_end(*rest, wanted);
  const auto example = test::mapped(*rest, low);
  const auto target = test::mapped(*rest, wanted);
  EXPECT_LT(distance(solved(rest, constraints, {example}), target->positions),
            0.3 * distance(solved(rest, constraints), target->positions));
}

TEST(Shell, KeepsTheVolumeOfAStretchedCylinderWhereItIsAskedTo) {
  const auto rest = small_cylinder();
  const auto stretch = [](const Vec3& p) { return Vec3(p.x(), p.y() + 0.575 * (p.y() > 0.5), p.z()); };
  const Constraints constraints = test::moved_end(*rest, stretch);
  const auto change = [&](double nu) {
    ShellOptions options;
    options.stiffness.nu = nu;
    const auto deformer = shell(rest, {}, options);
    deformer->solve(constraints, {});
    return volume_change(*rest, bent(*rest, *deformer));
  };
  EXPECT_GT(change(0), 0.2);
  EXPECT_LT(std::abs(change(1e7)), 1e-3);
}

TEST(Shell, PointsOfASeamStayTogetherAndLoosePointsAreCarried) {
  Shape split = *small_cylinder();
  // Every face gets corners of its own.
  Faces faces;
  std::vector<Vec3> positions;
  for (std::size_t f = 0; f < split.faces.size(); ++f) {
    std::vector<Index> corners;
    for (const Index i : split.faces[f]) {
      corners.push_back(static_cast<Index>(positions.size()));
      positions.push_back(split.positions[i]);
    }
    faces.add(corners);
  }
  positions.emplace_back(0.2, 1.1, 0);  // beside the top
  positions.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  Shape soup;
  soup.positions = positions;
  soup.faces = faces;
  const auto rest = std::make_shared<const Shape>(soup);
  const Bend bend{40, 0.3, 0.5};
  Constraints constraints = test::moved_end(*rest, bend);
  const auto deformer = shell(rest);
  EXPECT_EQ(deformer->solve(constraints, {}).status, Status::Converged);
  const std::vector<Vec3> x = bent(*rest, *deformer);
  const auto whole = small_cylinder();
  const std::vector<Vec3> wanted = solved(whole, test::moved_end(*whole, bend));
  std::size_t k = 0;
  for (std::size_t f = 0; f < whole->faces.size(); ++f)
    for (const Index i : whole->faces[f]) ASSERT_LT((x[k++] - wanted[i]).norm(), 1e-6);
  EXPECT_LT((x[k] - bend(positions[k])).norm(), 0.02) << "a loose point near the handle";
  EXPECT_TRUE(std::isnan(x[k + 1].x()));
  EXPECT_GE(deformer->notes().size(), 2U);
}

TEST(Shell, APartThatNothingHoldsRests) {
  Shape two = *small_cylinder();
  const Index n = static_cast<Index>(two.size());
  const Shape one = two;
  for (const Vec3& p : one.positions) two.positions.push_back(p + Vec3(3, 0, 0));
  for (std::size_t f = 0; f < one.faces.size(); ++f) {
    std::vector<Index> corners;
    for (const Index i : one.faces[f]) corners.push_back(i + n);
    two.faces.add(corners);
  }
  const auto rest = std::make_shared<const Shape>(two);
  Constraints constraints = test::moved_end(one, Bend{40, 0.3, 0.5});
  const auto deformer = shell(rest);
  const SolveReport report = deformer->solve(constraints, {});
  EXPECT_NE(report.message.find("1 part of the surface rest"), std::string::npos) << report.message;
  const std::vector<Vec3> x = bent(two, *deformer);
  for (Index i = n; i < x.size(); ++i) ASSERT_EQ(x[i], two.positions[i]);
}

TEST(Shell, AnotherOrderOfPointsGivesTheSameShape) {
  const auto rest = small_cylinder();
  const Bend bend{70, 0.3, 0.5};
  const std::vector<Vec3> x = solved(rest, test::moved_end(*rest, bend));
  std::vector<Index> order(rest->size());
  std::iota(order.begin(), order.end(), Index{0});
  for (Index i = 0; i < order.size(); ++i)
    std::swap(order[i], order[static_cast<std::size_t>(random_unit(3, i) * static_cast<double>(order.size()))]);
  Shape mixed;
  mixed.positions.resize(rest->size());
  for (Index i = 0; i < order.size(); ++i) mixed.positions[order[i]] = rest->positions[i];
  for (std::size_t f = rest->faces.size(); f-- > 0;) {
    std::vector<Index> corners;
    for (const Index i : rest->faces[f]) corners.push_back(order[i]);
    mixed.faces.add(corners);
  }
  const auto other = std::make_shared<const Shape>(mixed);
  const std::vector<Vec3> y = solved(other, test::moved_end(mixed, bend));
  for (Index i = 0; i < order.size(); ++i) ASSERT_LT((y[order[i]] - x[i]).norm(), 1e-5);
}

TEST(Shell, StartsFromItsOwnPoseAndFollowsAnotherFrame) {
  const auto rest = small_cylinder();
  const Constraints constraints = test::moved_end(*rest, Bend{70, 0.3, 0.5});
  const auto deformer = shell(rest);
  deformer->solve(constraints, {});
  const Pose pose = deformer->pose();
  const auto again = shell(rest);
  again->start_from(pose);
  EXPECT_LE(again->solve(constraints, {}).iterations, 3);
  EXPECT_LT(distance(bent(*rest, *again), bent(*rest, *deformer)), 1e-3);
  again->reset();
  EXPECT_LT(distance(bent(*rest, *again), rest->positions), 1e-15);

  const auto moved = test::mapped(*rest, [](const Vec3& p) { return Vec3(p + Vec3(0.1, 0, 0)); });
  const auto follower = shell(rest);
  follower->follow(moved);
  const SolveReport report = follower->solve(test::moved_end(*moved, [](const Vec3& p) { return p; }), {});
  EXPECT_EQ(report.status, Status::Converged);
  EXPECT_LT(distance(bent(*moved, *follower), moved->positions), 1e-9);
}

TEST(Shell, TablesOfAPoseBindAsTheDeformerDoes) {
  const auto rest = small_cylinder();
  const auto deformer = shell(rest);
  deformer->solve(test::moved_end(*rest, Bend{70, 0.3, 0.5}), {});
  std::vector<Vec3> points;
  for (std::uint64_t i = 0; i < 200; ++i)
    points.emplace_back(0.3 * random_unit(1, 3 * i) - 0.15, 1.1 * random_unit(1, 3 * i + 1),
                        0.3 * random_unit(1, 3 * i + 2) - 0.15);
  const SkinWeights a = deformer->bind(points, Gradients::Yes),
                    b = shell_method().bind(deformer->binding(), points, Gradients::Yes);
  EXPECT_EQ(a.maps, b.maps);
  EXPECT_EQ(a.weights, b.weights);
  // Gradients are those of the weights.
  const double h = 1e-4;
  std::vector<Vec3> more = points;
  for (Vec3& p : more) p.x() += h;
  const SkinWeights c = deformer->bind(more, Gradients::No);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (a.offsets[i + 1] - a.offsets[i] != 3 || c.offsets[i + 1] - c.offsets[i] != 3) continue;
    bool same = true;
    for (std::size_t k = 0; k < 3; ++k) same = same && a.maps[a.offsets[i] + k] == c.maps[c.offsets[i] + k];
    for (std::size_t k = 0; same && k < 3; ++k, ++compared) {
      const std::size_t e = a.offsets[i] + k, f = c.offsets[i] + k;
      EXPECT_NEAR(a.gradients[e].x(), static_cast<double>(c.weights[f] - a.weights[e]) / h, 0.05);
    }
  }
  EXPECT_GT(compared, 50U);
}

TEST(Shell, StiffnessMovesTheBend) {
  const auto rest = small_cylinder();
  const Constraints even = test::moved_end(*rest, Bend{90, 0.3, 0.5});
  Constraints stiff = even;
  Stiff part{{}, 50};
  for (Index i = 0; i < rest->size(); ++i)
    if (rest->positions[i].y() > 0.5) part.points.push_back(i);
  stiff.stiffness.push_back(part);
  const std::vector<Vec3> a = solved(rest, even), b = solved(rest, stiff);
  const auto strain = [&](const std::vector<Vec3>& x) {
    double sum = 0;
    for (const auto& [i, j] : edges_of(rest->faces))
      if (rest->positions[i].y() > 0.55 && rest->positions[j].y() > 0.55) {
        const double r = (x[i] - x[j]).norm() / (rest->positions[i] - rest->positions[j]).norm() - 1;
        sum += r * r;
      }
    return sum;
  };
  EXPECT_LT(strain(b), 0.5 * strain(a));
}

std::string message_of(const std::shared_ptr<const Shape>& rest, std::vector<std::shared_ptr<const Shape>> examples) {
  try {
    shell(rest, std::move(examples));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Shell, SaysWhatDoesNotFit) {
  const auto rest = small_cylinder();
  Shape cloud;
  cloud.positions = rest->positions;
  EXPECT_EQ(message_of(std::make_shared<const Shape>(cloud), {}),
            "expected faces for a shell, found none: bend points without faces with method graph");
  Shape other = *rest;
  std::swap(other.faces.points[30], other.faces.points[31]);
  EXPECT_NE(message_of(rest, {rest, std::make_shared<const Shape>(other)})
                .find("example 2 does not correspond to the rest shape: expected face 10 of "),
            std::string::npos);
  Shape fewer = *rest;
  fewer.positions.pop_back();
  EXPECT_NE(
      message_of(rest, {std::make_shared<const Shape>(fewer)})
          .find("expected " + std::to_string(rest->size()) + " points, found " + std::to_string(rest->size() - 1)),
      std::string::npos)
      << message_of(rest, {std::make_shared<const Shape>(fewer)});
  Shape flat;
  flat.positions.assign(3, Vec3(1, 2, 3));
  flat.faces.add(std::array<Index, 3>{0, 1, 2});
  EXPECT_NE(message_of(std::make_shared<const Shape>(flat), {}).find("in one place"), std::string::npos);
}

}  // namespace
}  // namespace sinew
