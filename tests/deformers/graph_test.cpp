#include "deformers/graph.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "deformers/graph_solver.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/error.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/random.h"
#include "engine/geometry/skin.h"

namespace sinew {

namespace {

constexpr Index side = 30;

/// A bumpy sheet of side x side points (about 1 x 1), as a cloud.
Shape sheet() {
  Shape shape;
  for (Index y = 0; y < side; ++y)
    for (Index x = 0; x < side; ++x)
      shape.positions.emplace_back(x / 29.0 + 1e-3 * random_unit(1, y * side + x),
                                   y / 29.0 + 1e-3 * random_unit(2, y * side + x),
                                   0.03 * std::sin(0.9 * x) * std::cos(0.7 * y));
  return shape;
}

std::vector<Index> given_nodes() {
  std::vector<Index> nodes;
  for (Index y = 1; y < side; y += 4)
    for (Index x = 1; x < side; x += 4) nodes.push_back(y * side + x);
  return nodes;
}

/// Left edge fixed; right edge lifted and turned.
Constraints lift(const Shape& shape) {
  Constraints c;
  Handle handle;
  const Eigen::AngleAxisd turn(0.6, Vec3::UnitY());
  for (Index y = 0; y < side; ++y) {
    c.fixed.push_back(y * side);
    handle.points.push_back(y * side + side - 1);
    const Vec3& p = shape.positions[y * side + side - 1];
    handle.targets.push_back(turn * (p - Vec3(1, 0, 0)) + Vec3(0.8, 0.05, 0.4));
  }
  c.handles.push_back(handle);
  return c;
}

GraphOptions with_given() {
  GraphOptions options;
  options.given = given_nodes();
  return options;
}

std::unique_ptr<Deformer> deformer_of(const Shape& shape, const GraphOptions& options) {
  return make_graph_deformer(std::make_shared<Shape>(shape), options);
}

std::vector<Vec3> bent(const Deformer& deformer, const Shape& rest) {
  return skin(rest, deformer.weights(), deformer.pose()).positions;
}

double largest_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double d = 0;
  for (std::size_t i = 0; i < a.size(); ++i) d = std::max(d, (a[i] - b[i]).norm());
  return d;
}

/// Every coordinate through p -> s R p + t, targets too.
struct Similarity {
  double s = 1;
  Mat3 R = Mat3::Identity();
  Vec3 t = Vec3::Zero();

  Vec3 operator()(const Vec3& p) const { return s * (R * p) + t; }
  Shape operator()(Shape shape) const {
    for (Vec3& p : shape.positions) p = (*this)(p);
    return shape;
  }
  Constraints operator()(Constraints c) const {
    for (Handle& h : c.handles)
      for (Vec3& q : h.targets) q = (*this)(q);
    return c;
  }
};

double energy_of(const SolveReport& report) {
  return report.energy.front().second;
}

}  // namespace

TEST(Graph, HandlesAtRestChangeNoBit) {
  const Shape shape = sheet();
  const auto deformer = deformer_of(shape, with_given());
  Constraints c = lift(shape);
  for (std::size_t i = 0; i < c.handles[0].points.size(); ++i)
    c.handles[0].targets[i] = shape.positions[c.handles[0].points[i]];
  const SolveReport report = deformer->solve(c, {});
  EXPECT_EQ(report.status, Status::Converged);
  EXPECT_LT(energy_of(report), 1e-20);
  EXPECT_LT(largest_distance(bent(*deformer, shape), shape.positions), 1e-9);
}

TEST(Graph, FixedPointsKeepTheirBits) {
  const Shape shape = sheet();
  const auto deformer = deformer_of(shape, with_given());
  const Constraints c = lift(shape);
  EXPECT_EQ(deformer->solve(c, {}).status, Status::Converged);
  const std::vector<Vec3> after = bent(*deformer, shape);
  for (const Index i : c.fixed) EXPECT_EQ(after[i], shape.positions[i]);
  EXPECT_GT(largest_distance(after, shape.positions), 0.3);
}

TEST(Graph, RigidMotionsOfTheHandlesMoveEverythingRigidly) {
  const Shape shape = sheet();
  const auto deformer = deformer_of(shape, with_given());
  const Similarity motion{1, Eigen::AngleAxisd(2.5, Vec3(1, 2, -1).normalized()).toRotationMatrix(), Vec3(3, -1, 2)};
  Constraints c = lift(shape);
  c.fixed.clear();
  for (const Index i : {0u, 15u, 400u, 899u}) {
    c.handles[0].points.push_back(i);
    c.handles[0].targets.push_back(Vec3::Zero());
  }
  for (std::size_t i = 0; i < c.handles[0].points.size(); ++i)
    c.handles[0].targets[i] = motion(shape.positions[c.handles[0].points[i]]);
  const SolveReport report = deformer->solve(c, {});
  EXPECT_EQ(report.status, Status::Converged);
  EXPECT_LT(largest_distance(bent(*deformer, shape), motion(shape).positions), 1e-5);
}

TEST(Graph, TheSameInAnyUnitAtAnyPlaceAndTurned) {
  const Shape shape = sheet();
  const Constraints c = lift(shape);
  const auto deformer = deformer_of(shape, with_given());
  const SolveReport report = deformer->solve(c, {});
  const std::vector<Vec3> expected = bent(*deformer, shape);
  const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, 1, 3).normalized()).toRotationMatrix();
  const Similarity cases[] = {{1000, Mat3::Identity(), Vec3::Zero()},
                              {1, Mat3::Identity(), Vec3(448000, 5400000, 120)},
                              {1e-4, Mat3::Identity(), Vec3::Zero()},
                              {1, turn, Vec3(1, 2, 3)},
                              {0.3048, turn, Vec3(500000, 0, -70000)}};
  for (const Similarity& similarity : cases) {
    Shape moved = similarity(shape);
    Constraints targets = similarity(c);
    set_origin(moved);
    for (Vec3& q : targets.handles[0].targets) q -= moved.origin;
    const auto other = deformer_of(moved, with_given());
    const SolveReport r = other->solve(targets, {});
    EXPECT_EQ(r.status, Status::Converged);
    // Turned, the bounding box and with it the unit of length is another, and the weights shift a little.
    const bool turned = !similarity.R.isIdentity();
    if (!turned) {
      EXPECT_NEAR(energy_of(r), energy_of(report), 1e-6 * energy_of(report));
    }
    double worst = 0;
    const std::vector<Vec3> after = bent(*other, moved);
    for (std::size_t i = 0; i < after.size(); ++i)
      worst = std::max(worst, (after[i] + moved.origin - similarity(expected[i])).norm() / similarity.s);
    EXPECT_LT(worst, turned ? 0.02 : 2e-6);
  }
}

TEST(Graph, TheOrderOfPointsDoesNotMatter) {
  const Shape shape = sheet();
  const Constraints c = lift(shape);
  const auto deformer = deformer_of(shape, with_given());
  deformer->solve(c, {});
  const std::vector<Vec3> expected = bent(*deformer, shape);

  std::vector<Index> order(shape.size()), place(shape.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [](Index a, Index b) { return random_bits(5, a) < random_bits(5, b); });
  Shape shuffled;
  for (Index i = 0; i < order.size(); ++i) {
    shuffled.positions.push_back(shape.positions[order[i]]);
    place[order[i]] = i;
  }
  Constraints moved = c;
  for (Index& i : moved.fixed) i = place[i];
  for (Index& i : moved.handles[0].points) i = place[i];
  GraphOptions options = with_given();
  for (Index& i : options.given) i = place[i];
  const auto other = deformer_of(shuffled, options);
  other->solve(moved, {});
  const std::vector<Vec3> after = bent(*other, shuffled);
  for (Index i = 0; i < order.size(); ++i) EXPECT_LT((after[i] - expected[order[i]]).norm(), 1e-9);
}

TEST(Graph, TheSameBitsForAnyNumberOfThreads) {
  const Shape shape = sheet();
  std::vector<std::vector<Vec3>> results;
  for (const int threads : {1, 2, 7}) {
    set_thread_count(threads);
    const auto deformer = deformer_of(shape, {});
    deformer->solve(lift(shape), {});
    results.push_back(bent(*deformer, shape));
  }
  set_thread_count(2);
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

TEST(Graph, FastAndPlainEndAtTheSameMinimum) {
  const Shape shape = sheet();
  GraphOptions plain = with_given();
  plain.plain = true;
  const auto fast = deformer_of(shape, with_given()), reference = deformer_of(shape, plain);
  const SolveReport a = fast->solve(lift(shape), {}), b = reference->solve(lift(shape), {});
  EXPECT_EQ(a.status, Status::Converged);
  EXPECT_EQ(b.status, Status::Converged);
  EXPECT_NEAR(energy_of(a), energy_of(b), 1e-6 * energy_of(b));
  EXPECT_LT(largest_distance(bent(*fast, shape), bent(*reference, shape)), 1e-4);
}

TEST(Graph, TheWayOfADragDoesNotChangeTheFinalAnswer) {
  const Shape shape = sheet();
  const Constraints c = lift(shape);
  const auto cold = deformer_of(shape, with_given()), dragged = deformer_of(shape, with_given());
  const SolveReport expected = cold->solve(c, {});
  SolveOptions quick;
  quick.quality = SolveOptions::Quality::Interactive;
  for (int step = 1; step <= 10; ++step) {
    Constraints part = c;
    for (std::size_t i = 0; i < part.handles[0].points.size(); ++i) {
      const Vec3& p = shape.positions[part.handles[0].points[i]];
      part.handles[0].targets[i] = p + 0.1 * step * (part.handles[0].targets[i] - p);
    }
    EXPECT_NE(dragged->solve(part, quick).status, Status::Failed);
  }
  const SolveReport report = dragged->solve(c, {});
  EXPECT_NEAR(energy_of(report), energy_of(expected), 1e-6 * energy_of(expected));
  EXPECT_LT(largest_distance(bent(*dragged, shape), bent(*cold, shape)), 1e-4);
}

TEST(Graph, HandlesMayComeAndGo) {
  const Shape shape = sheet();
  const auto kept = deformer_of(shape, with_given()), fresh = deformer_of(shape, with_given());
  Constraints c = lift(shape), more = c;
  more.fixed.push_back(15 * side + 15);
  more.handles.push_back({{29 * side}, {shape.positions[29 * side] + Vec3(0, 0, -0.2)}});
  kept->solve(more, {});
  kept->solve(c, {});
  fresh->solve(c, {});
  EXPECT_LT(largest_distance(bent(*kept, shape), bent(*fresh, shape)), 1e-4);
}

TEST(Graph, WhatNothingHoldsRests) {
  Shape shape = sheet();
  const std::size_t n = shape.size();
  for (std::size_t i = 0; i < n; ++i) shape.positions.push_back(shape.positions[i] + Vec3(0, 0, 50));  // a far island
  GraphOptions options = with_given();
  for (const Index i : given_nodes()) options.given.push_back(i + static_cast<Index>(n));
  const auto deformer = deformer_of(shape, options);
  const SolveReport report = deformer->solve(lift(shape), {});
  EXPECT_EQ(report.status, Status::Converged);
  EXPECT_NE(report.message.find("64 of 128 nodes rest"), std::string::npos) << report.message;
  const std::vector<Vec3> after = bent(*deformer, shape);
  for (std::size_t i = n; i < 2 * n; ++i) ASSERT_EQ(after[i], shape.positions[i]);
}

TEST(Graph, OneHandleAloneCarriesTheShapeWithoutSpinningIt) {
  const Shape shape = sheet();
  const auto deformer = deformer_of(shape, with_given());
  Constraints c;
  c.handles.push_back({{465}, {shape.positions[465] + Vec3(1, 2, 3)}});
  const SolveReport report = deformer->solve(c, {});
  EXPECT_EQ(report.status, Status::Converged);
  const std::vector<Vec3> after = bent(*deformer, shape);
  for (std::size_t i = 0; i < after.size(); ++i)
    EXPECT_LT((after[i] - shape.positions[i] - Vec3(1, 2, 3)).norm(), 1e-3);
}

TEST(Graph, NoConstraintsNoMotion) {
  const Shape shape = sheet();
  const auto deformer = deformer_of(shape, {});
  EXPECT_EQ(deformer->solve({}, {}).iterations, 0);
  EXPECT_EQ(bent(*deformer, shape), shape.positions);
}

TEST(Graph, CanBeStoppedAndStartedFromAPose) {
  const Shape shape = sheet();
  const Constraints c = lift(shape);
  const auto deformer = deformer_of(shape, with_given());
  SolveOptions one_step;
  one_step.on_iteration = [&](const Pose& pose) {
    EXPECT_EQ(pose.size(), given_nodes().size());
    return false;
  };
  const SolveReport stopped = deformer->solve(c, one_step);
  EXPECT_EQ(stopped.status, Status::Stopped);
  EXPECT_EQ(stopped.iterations, 1);
  const SolveReport done = deformer->solve(c, {});
  EXPECT_EQ(done.status, Status::Converged);

  const Pose pose = deformer->pose();
  const std::vector<Vec3> expected = bent(*deformer, shape);
  deformer->reset();
  EXPECT_EQ(bent(*deformer, shape), shape.positions);
  deformer->start_from(pose);
  EXPECT_LT(largest_distance(bent(*deformer, shape), expected), 1e-12);
  const SolveReport again = deformer->solve(c, {});
  EXPECT_LT(largest_distance(bent(*deformer, shape), expected), 1e-5);
  EXPECT_LT(again.iterations, done.iterations + stopped.iterations + 8);
}

TEST(Graph, AfterAResetTheAnswerDependsOnTheConstraintsAlone) {
  const Shape shape = sheet();
  const Constraints c = lift(shape);
  const auto fresh = deformer_of(shape, with_given()), used = deformer_of(shape, with_given());
  fresh->solve(c, {});
  SolveOptions quick;
  quick.quality = SolveOptions::Quality::Interactive;
  for (int step = 1; step < 5; ++step) {
    Constraints other = c;
    for (Vec3& q : other.handles[0].targets) q += 0.05 * step * Vec3(0, 1, 1);
    used->solve(other, step % 2 == 0 ? quick : SolveOptions{});
  }
  used->reset();
  used->solve(c, {});
  EXPECT_EQ(bent(*used, shape), bent(*fresh, shape));
  // A start given before the first solve is taken; here it is the answer itself.
  const auto started = deformer_of(shape, with_given());
  started->start_from(fresh->pose());
  EXPECT_LT(started->solve(c, {}).iterations, fresh->solve(c, {}).iterations + 6);
  EXPECT_LT(largest_distance(bent(*started, shape), bent(*fresh, shape)), 1e-5);
}

TEST(Graph, PointsThatAreNotFiniteStayAndHoldNothing) {
  Shape shape = sheet();
  shape.positions[7] = Vec3(std::nan(""), 0, 0);
  Constraints c = lift(shape);
  c.fixed.push_back(7);
  c.handles[0].points.push_back(7);
  c.handles[0].targets.push_back(Vec3(1, 1, 1));
  const auto deformer = deformer_of(shape, with_given());
  EXPECT_EQ(deformer->solve(c, {}).status, Status::Converged);
  const std::vector<Vec3> after = bent(*deformer, shape);
  EXPECT_TRUE(std::isnan(after[7].x()));
  EXPECT_TRUE(after[8].allFinite());
}

TEST(Graph, ABindingMovesOtherPointsOfTheSameSpace) {
  const Shape shape = sheet();
  const auto deformer = deformer_of(shape, with_given());
  deformer->solve(lift(shape), {});
  const Method method = graph_method();
  const SkinWeights bound = method.bind(deformer->binding(), shape.positions, Gradients::No);
  EXPECT_EQ(bound.maps, deformer->weights().maps);
  EXPECT_EQ(bound.weights, deformer->weights().weights);
  EXPECT_THROW(method.bind({}, shape.positions, Gradients::No), InputError);
  EXPECT_THROW(
      method.bind({{"nodes", 3, {0, 0, std::nan("")}}, {"neighbours", 1, {4}}}, shape.positions, Gradients::No),
      InputError);
  EXPECT_THROW(method.bind({{"nodes", 3, {0, 0, 0}}, {"neighbours", 1, {0}}}, shape.positions, Gradients::No),
               InputError);
}

TEST(Graph, SaysWhatItCannotBend) {
  EXPECT_THROW(deformer_of(Shape{}, {}), InputError);
  GraphOptions wrong;
  wrong.given = {5000};
  EXPECT_THROW(deformer_of(sheet(), wrong), InputError);
  GraphOptions simplify;
  simplify.simplify = true;
  EXPECT_THROW(deformer_of(sheet(), simplify), InputError);
}

TEST(GraphSolver, TheEnergyNeverRises) {
  const Shape shape = sheet();
  const auto deformer = deformer_of(shape, with_given());
  // The same case by hand, to see the state after each iteration.
  const Deformer::Structure structure = deformer->structure();
  GraphSolver solver(structure.vertices, structure.edges, {}, false);
  std::vector<bool> fixed(structure.vertices.size(), false);
  fixed[0] = true;
  GraphHandle handle{structure.vertices.back(), {static_cast<Index>(structure.vertices.size() - 1)}, {1.0}};
  solver.prepare(fixed, {handle});
  GraphEnergy energy;
  std::vector<bool> free(fixed.size());
  for (std::size_t j = 0; j < fixed.size(); ++j) free[j] = !fixed[j];
  energy.build(structure.vertices, structure.edges, free, std::vector{handle}, {});
  const std::vector<Vec3> target = {Vec3(-0.5, 0.2, 1)};
  energy.set_targets(target);
  double last = energy.energy(solver.x(), false).total();
  int seen = 0;
  const SolveReport report = solver.solve(target, {}, [&] {
    const double F = energy.energy(solver.x(), false).total();
    EXPECT_LE(F, last * (1 + 1e-12));
    last = F;
    ++seen;
    return true;
  });
  EXPECT_EQ(report.status, Status::Converged);
  EXPECT_EQ(seen, report.iterations);
  EXPECT_GT(seen, 3);
}

}  // namespace sinew
