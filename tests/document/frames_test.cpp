/// Edits over time: keys of mesh animations, paths through streams; a frame's answer is its own.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "deformers/methods.h"
#include "engine/document/evaluate.h"
#include "engine/geometry/error.h"
#include "engine/geometry/skin.h"
#include "tests/document/moving.h"
#include "tests/document/toy_method.h"

namespace sinew::document {

namespace {

/// Positions of a frame in a workspace of its own.
std::vector<Vec3> alone(const std::shared_ptr<const Sequence>& input, std::span<const Layer> layers, int frame) {
  Workspace workspace(input, methods());
  return evaluate(workspace, layers, frame).shape->positions;
}

std::string refusal(const std::shared_ptr<const Sequence>& input, std::span<const Layer> layers, int frame) {
  try {
    alone(input, layers, frame);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

Key key(int frame, const Vec3& move, Interpolation interpolation = Interpolation::Linear) {
  Key out;
  out.frame = frame;
  out.handles.emplace_back().move = move;
  out.interpolation = interpolation;
  return out;
}

}  // namespace

TEST(Frames, AnAnswerDoesNotDependOnWhatWasSolvedBefore) {
  const auto input = std::make_shared<const Sequence>(waving_tube(9));
  std::vector<Layer> layers{tube_layer()};
  layers[0].keys = {key(3, Vec3(0, 0.2, 0), Interpolation::Smooth), key(7, Vec3(0.1, -0.4, 0))};
  layers.push_back(layers[0]);  // a second layer, keyed at other frames
  layers[1].keys = {key(1, Vec3(0, 0, 0)), key(5, Vec3(0, 0, 0.3))};

  std::vector<std::vector<Vec3>> forward(10), backward(10);
  Workspace one(input, methods()), other(input, methods());
  for (int frame = 1; frame <= 9; ++frame) forward[frame] = evaluate(one, layers, frame).shape->positions;
  for (int frame = 9; frame >= 1; --frame) backward[frame] = evaluate(other, layers, frame).shape->positions;
  for (int frame = 1; frame <= 9; ++frame) {
    EXPECT_TRUE(forward[frame] == backward[frame]) << frame;
    if (frame % 3 != 2) continue;
    EXPECT_TRUE(forward[frame] == alone(input, layers, frame)) << frame;
  }
  // What such a check would see: a solve that begins at another frame's answer ends elsewhere in the last digits.
  Workspace warm(input, methods());
  UpdateOptions options;
  options.solve.quality = SolveOptions::Quality::Interactive;
  options.frame = 6;
  warm.update(layers, options);
  const UpdateResult rough = warm.update(layers, options);
  std::vector<Vec3> bent(input->load(6)->size());
  skin_points(*rough.layers[0].weights, *rough.layers[0].pose, input->load(6)->positions, bent);
  EXPECT_FALSE(bent == forward[6]);
}

TEST(Frames, AtItsKeysAHandleIsWhereTheyPutIt) {
  const auto input = std::make_shared<const Sequence>(waving_tube(9));
  std::vector<Layer> layers{tube_layer()};
  layers[0].keys = {key(3, Vec3(0, 0.2, 0)), key(7, Vec3(0, -0.2, 0), Interpolation::Hold), key(8, Vec3(0, 0, 0))};
  const auto lift = [&](int frame) {
    const std::vector<Vec3> bent = alone(input, layers, frame);
    return Vec3(bent.back() - input->load(frame)->positions.back());
  };
  EXPECT_LT((lift(1) - Vec3(0, 0.2, 0)).norm(), 0.01);
  EXPECT_LT((lift(3) - Vec3(0, 0.2, 0)).norm(), 0.01);
  EXPECT_LT(lift(5).norm(), 0.01);
  EXPECT_LT((lift(7) - Vec3(0, -0.2, 0)).norm(), 0.01);
  EXPECT_LT(lift(9).norm(), 0.01);
}

TEST(Frames, AnEditWithoutKeysSpreadsOverTheClipAndFixedPointsStayOnTheAnimation) {
  const auto input = std::make_shared<const Sequence>(waving_tube(5));
  std::vector<Layer> layers{tube_layer()};
  layers[0].handles[0].motion.move = Vec3(0, 0, 0.3);
  for (const int frame : input->frames) {
    const std::vector<Vec3> rest = input->load(frame)->positions;
    const std::vector<Vec3> bent = alone(input, layers, frame);
    EXPECT_EQ(bent.front(), rest.front()) << frame;
    EXPECT_LT((bent.back() - rest.back() - Vec3(0, 0, 0.3)).norm(), 0.015) << frame;
  }
}

TEST(Frames, KeysMoveAStill) {
  const auto input = std::make_shared<const Sequence>(still(waving_tube(2).load(1)));
  std::vector<Layer> layers{tube_layer()};
  layers[0].keys = {key(10, Vec3(0, 0, 0)), key(20, Vec3(0, 0.2, 0))};
  const Vec3 rest = input->load(1)->positions.back();
  EXPECT_LT((alone(input, layers, 10).back() - rest).norm(), 1e-6);
  EXPECT_LT((alone(input, layers, 15).back() - rest - Vec3(0, 0.1, 0)).norm(), 0.01);
  EXPECT_LT((alone(input, layers, 20).back() - rest - Vec3(0, 0.2, 0)).norm(), 0.01);
}

TEST(Frames, WhatIsNoMeshAnimationIsRefusedWithItsFrame) {
  const auto jet = std::make_shared<const Sequence>(arc_stream(12));
  std::vector<Layer> layers{tube_layer()};
  layers[0].handles[0].points.what = SelectIndices{Shared<Index>({0})};
  layers[0].fixed.clear();
  EXPECT_EQ(refusal(jet, layers, 5).substr(0, 57), "frame 4: expected 8 points as in frame 1, found 32; a lay");
  const auto tube = std::make_shared<const Sequence>(waving_tube(3));
  EXPECT_EQ(refusal(tube, layers, 4), "frame: expected a frame of the input (1-3), found 4");
  layers[0].keys = {key(7, Vec3(0, 0, 0))};
  EXPECT_EQ(refusal(tube, layers, 1), "layer: expected a frame of the input (1-3), found 7");
  layers = {path_layer(2)};
  for (Selection* selection : {&layers[0].fixed[0], &layers[0].handles[0].points}) selection->frame = 12;
  layers[0].path->id = 4711;
  EXPECT_EQ(refusal(jet, layers, 5),
            "path: expected a particle that is there in two or more of the sampled frames, found the id in 0 of them");
}

TEST(Frames, AStreamIsBentWhereverItsParticlesAre) {
  const auto input = std::make_shared<const Sequence>(arc_stream(24));
  std::vector<Layer> layers{path_layer(2)};
  layers[0].handles[0].motion.move = Vec3(0, 0, 1);
  Workspace workspace(input, methods());
  double highest = 0;
  for (const int frame : {3, 12, 24}) {
    const std::shared_ptr<const Shape> rest = input->load(frame);
    const Evaluation bent = evaluate(workspace, layers, frame);
    ASSERT_EQ(bent.shape->size(), rest->size());
    EXPECT_EQ(bent.shape->find("id")->values, rest->find("id")->values);
    for (std::size_t i = 0; i < rest->size(); ++i)
      highest = std::max(highest, (bent.shape->positions[i] - rest->positions[i]).z());
    EXPECT_TRUE(bent.shape->positions == alone(input, layers, frame));
  }
  EXPECT_GT(highest, 0.8);
  EXPECT_LT(highest, 1.3);
}

TEST(Frames, BentVelocitiesAreTheDerivativeOfBentPositions) {
  // Frames so close that a difference of two is a derivative.
  constexpr int fine = 16;
  const auto input = std::make_shared<const Sequence>(arc_stream(24, fine));
  std::vector<Layer> layers{path_layer(3 * fine)};
  for (Selection* selection : {&layers[0].fixed[0], &layers[0].handles[0].points}) selection->frame = 16 * fine;
  for (const bool keyed : {false, true}) {
    layers[0].handles[0].motion.move = Vec3(0, 0, 1);
    if (keyed) layers[0].keys = {key(1, Vec3(0, 0, 0), Interpolation::Smooth), key(24 * fine, Vec3(0, 0.5, 2))};
    Workspace workspace(input, methods());
    double error = 0, size = 0, plain_error = 0;
    for (const int frame : {8 * fine, 12 * fine, 17 * fine}) {
      const Evaluation before = evaluate(workspace, layers, frame - 1), after = evaluate(workspace, layers, frame + 1);
      const Evaluation now = evaluate(workspace, layers, frame);
      const auto rest = input->load(frame);
      for (const auto& [id, difference] : central_differences(*before.shape, *after.shape, 2 / input->rate)) {
        const auto i = row_of(*now.shape, id);
        if (i == now.shape->size()) continue;
        error += (velocity(*now.shape, i) - difference).squaredNorm();
        plain_error += (velocity(*rest, row_of(*rest, id)) - difference).squaredNorm();
        size += difference.squaredNorm();
      }
    }
    EXPECT_LT(std::sqrt(error / size), 0.01) << keyed;
    EXPECT_GT(std::sqrt(plain_error / size), 0.05) << keyed << ": the edit is too small to tell";
  }
}

}  // namespace sinew::document
