#include "engine/document/workspace.h"

#include <gtest/gtest.h>

#include "engine/document/evaluate.h"
#include "engine/io/io.h"
#include "tests/document/toy_method.h"

namespace sinew::document {

namespace {

/// A layer that moves the point `at` by `move`.
Layer mover(Index at, const Vec3& move) {
  Layer layer;
  layer.method = "toy";
  HandleEdit handle;
  handle.points.what = SelectIndices{Shared<Index>({at})};
  handle.motion.move = move;
  layer.handles = {handle};
  return layer;
}

UpdateOptions with(SolveOptions::Quality quality) {
  UpdateOptions options;
  options.solve.quality = quality;
  return options;
}

constexpr auto final_quality = SolveOptions::Quality::Final;
constexpr auto interactive = SolveOptions::Quality::Interactive;

}  // namespace

TEST(Evaluate, ALayerWorksOnTheOutputOfTheOneBelow) {
  const Method methods[] = {toy_method()};
  Layer to = mover(0, Vec3(0, 0, 0));
  to.handles[0].motion = {};
  to.handles[0].motion.to = Shared<Vec3>({Vec3(0, 5, 0)});
  const std::vector<Layer> layers{mover(1, Vec3(1, 0, 0)), to};
  const Evaluation out = evaluate(line_of_points(3), layers, methods);
  EXPECT_NEAR((out.shape->positions[0] - Vec3(0, 5, 0)).norm(), 0, 1e-11);
  EXPECT_NEAR((out.shape->positions[2] - Vec3(2, 5, 0)).norm(), 0, 1e-11);
  ASSERT_EQ(out.reports.size(), 2u);
  EXPECT_EQ(out.reports[0].solve.status, Status::Converged);
  EXPECT_LT(out.reports[1].handle_max, 1e-11);
  EXPECT_GT(out.reports[0].solve.iterations, 10);
}

TEST(Evaluate, SelectionsAreMadeBeforeAnyEdit) {
  const Method methods[] = {toy_method()};
  Layer above = mover(0, Vec3(0, 1, 0));
  above.handles[0].points.what = SelectBox{Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5)};  // point 0, at rest
  const std::vector<Layer> layers{mover(1, Vec3(100, 0, 0)), above};
  const Evaluation out = evaluate(line_of_points(3), layers, methods);
  EXPECT_NEAR((out.shape->positions[0] - Vec3(100, 1, 0)).norm(), 0, 1e-9);
}

TEST(Evaluate, ALayerThatIsOffIsPassedOver) {
  const Method methods[] = {toy_method()};
  std::vector<Layer> layers{mover(1, Vec3(1, 0, 0)), mover(1, Vec3(0, 1, 0))};
  layers[0].on = false;
  const Evaluation out = evaluate(line_of_points(3), layers, methods);
  EXPECT_NEAR((out.shape->positions[0] - Vec3(0, 1, 0)).norm(), 0, 1e-11);
  ASSERT_EQ(out.layers.size(), 1u);
  EXPECT_EQ(out.layers[0].layer, 1u);
  EXPECT_EQ(evaluate(line_of_points(3), {}, methods).shape->positions[2], Vec3(2, 0, 0));
}

TEST(Evaluate, StartIsWhereTheSolveBegins) {
  const Method methods[] = {toy_method()};
  std::vector<Layer> layers{mover(1, Vec3(1, 0, 0))};
  Affine start = identity_map();
  start.col(3) = Vec3(1, 0, 0);
  layers[0].start = Shared<Affine>({start});
  EXPECT_EQ(evaluate(line_of_points(3), layers, methods).reports[0].solve.iterations, 0);
  layers[0].start = Shared<Affine>({start, start});
  EXPECT_THROW(evaluate(line_of_points(3), layers, methods), InputError);
}

TEST(Evaluate, CanBeCancelledWhileBuildingAndWhileSolving) {
  const Method methods[] = {toy_method()};
  const std::vector<Layer> layers{mover(1, Vec3(1, 0, 0))};
  for (const std::string phase : {"building", "solving"}) {
    const auto stop = [&](const char* what, std::size_t, double) { return what != phase; };
    EXPECT_THROW(evaluate(line_of_points(3), layers, methods, {stop}), io::Cancelled);
  }
}

TEST(Workspace, DoesNothingTwice) {
  int made = 0;
  const Method methods[] = {toy_method(&made)};
  Workspace workspace(line_of_points(4), methods);
  std::vector<Layer> layers{mover(1, Vec3(1, 0, 0)), mover(2, Vec3(0, 1, 0))};
  const UpdateResult first = workspace.update(layers, with(final_quality));
  EXPECT_EQ(made, 2);
  const UpdateResult second = workspace.update(layers, with(final_quality));
  EXPECT_EQ(made, 2);
  EXPECT_EQ(first.layers[0].pose, second.layers[0].pose);
  EXPECT_EQ(first.layers[1].pose, second.layers[1].pose);

  layers[1].handles[0].motion.move = Vec3(0, 2, 0);  // the upper layer alone
  const UpdateResult third = workspace.update(layers, with(final_quality));
  EXPECT_EQ(made, 2);
  EXPECT_EQ(first.layers[0].pose, third.layers[0].pose);
  EXPECT_NEAR((*third.layers[1].pose)[0](1, 3), 2, 1e-11);

  layers[1].settings = {{"count", 6.0, {}}};
  workspace.update(layers, with(final_quality));
  EXPECT_EQ(made, 3);
}

TEST(Workspace, WhileDraggingLayersAboveAreCarriedAndRemadeAtTheEnd) {
  int made = 0;
  const Method methods[] = {toy_method(&made)};
  Workspace workspace(line_of_points(4), methods);
  std::vector<Layer> layers{mover(1, Vec3(1, 0, 0)), mover(2, Vec3(0, 1, 0))};
  workspace.update(layers, with(final_quality));
  layers[0].handles[0].motion.move = Vec3(3, 0, 0);
  const UpdateResult drag = workspace.update(layers, with(interactive));
  EXPECT_EQ(made, 2);
  EXPECT_TRUE(drag.layers[0].solved);
  EXPECT_FALSE(drag.layers[1].solved);
  const UpdateResult end = workspace.update(layers, with(final_quality));
  EXPECT_EQ(made, 3);
  EXPECT_TRUE(end.layers[1].solved);
  EXPECT_NEAR(workspace.rest(1)->positions[0].x(), 3, 1e-11);
}

TEST(Workspace, AStoppedSolveGoesOnWhenAskedAgain) {
  const Method methods[] = {toy_method()};
  Workspace workspace(line_of_points(4), methods);
  const std::vector<Layer> layers{mover(1, Vec3(1, 0, 0))};
  UpdateOptions options = with(interactive);
  int seen = 0;
  options.on_iteration = [&](const std::vector<LayerResult>& results) {
    EXPECT_EQ(results.size(), 1u);
    EXPECT_NE(results[0].pose, nullptr);
    return ++seen < 3;
  };
  const UpdateResult stopped = workspace.update(layers, options);
  EXPECT_TRUE(stopped.stopped);
  EXPECT_EQ(stopped.layers[0].report.status, Status::Stopped);
  EXPECT_NEAR((*stopped.layers[0].pose)[0](0, 3), 0.875, 1e-12);
  const UpdateResult rest = workspace.update(layers, with(interactive));
  EXPECT_FALSE(rest.stopped);
  EXPECT_NEAR((*rest.layers[0].pose)[0](0, 3), 1, 1e-11);
}

}  // namespace sinew::document
