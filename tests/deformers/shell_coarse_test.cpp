// Large shells: solved on a coarse mesh, moved by its maps, reconstructed for the final answer.

#include "deformers/shell_coarse.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "deformers/shell.h"
#include "deformers/shell_pose.h"
#include "engine/geometry/affine.h"
#include "engine/geometry/bounds.h"
#include "tests/deformers/shell_shapes.h"

namespace sinew {
namespace {

using test::Bend;
using test::bent;

std::shared_ptr<const Shape> fine_cylinder() {
  return std::make_shared<const Shape>(samples::cylinder(40, 5, 90));
}

ShellOptions with_vertices(std::size_t count) {
  ShellOptions options;
  options.vertices = count;
  return options;
}

/// Greatest distance of the points of one surface from the other, both ways, in diagonals of the first.
double hausdorff(const Shape& shape, const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  const ShellMesh mesh = shell_mesh_of(shape, {});
  const auto one_way = [&](const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
    double worst = 0;
    for (const ShellSurface::Foot& foot : ShellSurface(to, mesh.triangles).feet(from))
      worst = std::max(worst, foot.distance);
    return worst;
  };
  return std::max(one_way(a, b), one_way(b, a)) / bounds_of(a).diagonal();
}

class ShellCoarseTest : public testing::Test {
 protected:
  const std::shared_ptr<const Shape> rest_ = fine_cylinder();
  const std::shared_ptr<const Shape> pose_ = test::mapped(*rest_, Bend{100, 0.3, 0.5});
};

TEST_F(ShellCoarseTest, HandlesOnAnyVertexAndFixedPointsAreMetExactlyInBothQualities) {
  const auto deformer = make_shell_deformer(rest_, {}, with_vertices(400));
  Constraints constraints = test::moved_end(*rest_, Bend{60, 0.3, 0.5});
  // A single vertex in the middle as well, drawn out.
  for (Index i = 0; i < rest_->size(); ++i)
    if (std::abs(rest_->positions[i].y() - 0.55) < 0.01 && rest_->positions[i].x() > 0.099) {
      constraints.handles.push_back({{i}, {Bend{60, 0.3, 0.5}(rest_->positions[i]) + Vec3(0.02, 0, 0)}});
      break;
    }
  ASSERT_EQ(constraints.handles.size(), 2U);
  SolveOptions options;
  for (const auto quality : {SolveOptions::Quality::Interactive, SolveOptions::Quality::Final}) {
    options.quality = quality;
    const SolveReport report = deformer->solve(constraints, options);
    EXPECT_LT(report.handle_max, 1e-9);
    const std::vector<Vec3> x = bent(*rest_, *deformer);
    for (const Index i : constraints.fixed) ASSERT_EQ(x[i], rest_->positions[i]);
    for (const Handle& handle : constraints.handles)
      for (std::size_t k = 0; k < handle.points.size(); ++k)
        ASSERT_LT((x[handle.points[k]] - handle.targets[k]).norm(), 1e-9);
  }
  const Figures counts = deformer->counts();
  EXPECT_NEAR(counts[1].second, 400, 40);
}

TEST_F(ShellCoarseTest, TheAnswerIsNearThatOfAllVertices) {
  const auto coarse = make_shell_deformer(rest_, std::vector{pose_}, with_vertices(1000)),
             full = make_shell_deformer(rest_, std::vector{pose_}, with_vertices(0));
  for (const double weight : {0.25, 0.5, 0.75}) {
    Constraints constraints;
    constraints.example_weights = {weight};
    coarse->reset();
    full->reset();
    coarse->solve(constraints, {});
    full->solve(constraints, {});
    EXPECT_LT(hausdorff(*rest_, bent(*rest_, *full), bent(*rest_, *coarse)), 0.005) << weight;
  }
}

TEST_F(ShellCoarseTest, SolvedAtTheEndItIsThatOfAllVertices) {
  ShellOptions options = with_vertices(400);
  options.finish = ShellOptions::Finish::Solved;
  const auto coarse = make_shell_deformer(rest_, std::vector{pose_}, options),
             full = make_shell_deformer(rest_, std::vector{pose_}, with_vertices(0));
  Constraints constraints = test::moved_end(*rest_, Bend{50, 0.3, 0.5});
  constraints.example_weights = {0.5};
  coarse->solve(constraints, {});
  full->solve(constraints, {});
  EXPECT_LT(hausdorff(*rest_, bent(*rest_, *full), bent(*rest_, *coarse)), 0.002);
}

TEST_F(ShellCoarseTest, WhatIsSeenWhileDraggingIsNearTheAnswer) {
  const auto deformer = make_shell_deformer(rest_, {}, with_vertices(500));
  const Constraints constraints = test::moved_end(*rest_, Bend{50, 0.3, 0.5});
  SolveOptions quick;
  quick.quality = SolveOptions::Quality::Interactive;
  deformer->solve(constraints, quick);
  const std::vector<Vec3> seen = bent(*rest_, *deformer);
  deformer->solve(constraints, {});
  EXPECT_LT(hausdorff(*rest_, bent(*rest_, *deformer), seen), 0.02);
}

TEST_F(ShellCoarseTest, AtRestNothingMovesAndARigidMotionIsExact) {
  const auto deformer = make_shell_deformer(rest_, {}, with_vertices(400));
  EXPECT_EQ(bent(*rest_, *deformer), rest_->positions);
  const Mat3 R = Eigen::AngleAxisd(0.8, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const auto motion = [&](const Vec3& p) { return Vec3(R * p + Vec3(0.2, -0.3, 0.1)); };
  Constraints constraints = test::moved_end(*rest_, motion);
  constraints.handles.push_back({constraints.fixed, {}});
  for (const Index i : std::exchange(constraints.fixed, {}))
    constraints.handles[1].targets.push_back(motion(rest_->positions[i]));
  deformer->solve(constraints, {});
  const std::vector<Vec3> x = bent(*rest_, *deformer);
  for (std::size_t i = 0; i < x.size(); ++i) ASSERT_LT((x[i] - motion(rest_->positions[i])).norm(), 1e-5);
}

TEST_F(ShellCoarseTest, MakingItCanBeCancelled) {
  int calls = 0;
  EXPECT_EQ(make_shell_deformer(rest_, {}, with_vertices(400), [&](double) { return ++calls < 2; }), nullptr);
  EXPECT_GE(calls, 2);
  const auto deformer = make_shell_deformer(rest_, {}, with_vertices(400));
  SolveOptions options;
  options.on_iteration = [](const Pose&) { return false; };
  EXPECT_EQ(deformer->solve(test::moved_end(*rest_, Bend{60, 0.3, 0.5}), options).status, Status::Stopped);
}

TEST(ShellCoarse, ATieIsWhereItsVertexIsAtRest) {
  const Shape shape = *fine_cylinder();
  const ShellMesh mesh = shell_mesh_of(shape, {});
  const auto coarse = ShellCoarse::make(mesh, 300, {});
  ASSERT_NE(coarse, nullptr);
  const std::vector<Vec3> rest = coarse->coarse_of(mesh.rest());
  std::size_t between = 0;
  for (Index v = 0; v < mesh.size(); ++v) {
    ASSERT_LT((coarse->tie_of(v, mesh.rest()).at(rest) - mesh.rest()[v]).norm(), 1e-12);
    between += coarse->number_of(v) == ShellCoarse::none;
  }
  EXPECT_GT(between, mesh.size() / 2);
}

}  // namespace
}  // namespace sinew
