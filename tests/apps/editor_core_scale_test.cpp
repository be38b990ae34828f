/// Scaling handles: the gizmo and S, what is kept of it in an edit, between keys, and in every method.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <numbers>
#include <random>
#include <set>

#include "apps/editor/keys.h"
#include "apps/editor/manipulation.h"
#include "apps/editor/session.h"
#include "apps/samples/meshes.h"
#include "deformers/methods.h"
#include "engine/document/edit.h"
#include "engine/document/evaluate.h"
#include "engine/document/keys.h"
#include "engine/document/selection.h"
#include "engine/io/io.h"
#include "tests/apps/editor_session.h"
#include "tests/io/temporary_folder.h"

namespace sinew::editor {

namespace {

using Vec2 = Eigen::Vector2d;
const Vec2 picture(1280, 720);

gpu::Camera camera_before(bool orthographic) {
  gpu::Camera camera;
  camera.eye = {0, 0, 4};
  camera.target = {0, 0, 0};
  camera.orthographic = orthographic;
  return camera;
}

Transform scale_by(const Vec3& factors, const Vec3& pivot) {
  Transform out;
  out.stretch = factors.asDiagonal();
  out.pivot = pivot;
  return out;
}

Gizmo scale_gizmo() {
  Gizmo gizmo;
  gizmo.kind = GizmoKind::Scale;
  return gizmo;
}

}  // namespace

TEST(EditorScale, EachPartIsHitWhereItIsDrawn) {
  gpu::Camera camera = camera_before(false);
  camera.eye = {2, 1.5, 3};
  const Gizmo gizmo = scale_gizmo();
  std::set<GizmoPart> parts;
  for (const GizmoStroke& stroke : gizmo_strokes(gizmo, camera, picture)) {
    parts.insert(stroke.part);
    const Vec2 at = stroke.filled ? Vec2((stroke.points[0] + stroke.points[2]) / 2) : stroke.points.back();
    EXPECT_EQ(hit_gizmo(gizmo, camera, picture, at), stroke.part);
  }
  EXPECT_EQ(parts, (std::set<GizmoPart>{GizmoPart::X, GizmoPart::Y, GizmoPart::Z, GizmoPart::Screen}));
}

TEST(EditorScale, AnAxisFollowsTheMouseAndTheMiddleScalesEvenly) {
  const gpu::Camera camera = camera_before(true);
  Manipulation along(scale_gizmo(), GizmoPart::X, {724, 360});
  along.move_mouse({640 + 1.5 * 84, 360}, camera, picture, 0);
  EXPECT_LT((along.motion().stretch - Mat3(Vec3(1.5, 1, 1).asDiagonal())).norm(), 1e-12);
  EXPECT_EQ(along.text(), "X × 1.5");

  Manipulation even(scale_gizmo(), GizmoPart::Screen, {642, 360});
  even.move_mouse({642 + 42, 360}, camera, picture, 0);
  EXPECT_LT((even.motion().stretch - 1.5 * Mat3::Identity()).norm(), 1e-12);

  // S: how much farther from the middle the mouse is than where it was pressed.
  Manipulation keyed(scale_gizmo(), GizmoPart::Screen, {640, 160});
  keyed.move_mouse({640 + 300, 360}, camera, picture, 0);
  EXPECT_LT((keyed.motion().stretch - 1.5 * Mat3::Identity()).norm(), 1e-12);
  keyed.move_mouse({640, 361}, camera, picture, 0);
  EXPECT_NEAR(keyed.motion().stretch(0, 0), least_scale, 1e-12) << "nothing is flattened";
}

TEST(EditorScale, KeysHoldTypeSnapAndCancel) {
  const gpu::Camera camera = camera_before(false);
  Manipulation scale(scale_gizmo(), GizmoPart::Screen, {640, 160});
  scale.move_mouse({640, 110}, camera, picture, 0);
  EXPECT_TRUE(scale.press('X', modifier::shift));
  EXPECT_EQ(scale.part(), GizmoPart::PlaneX);
  EXPECT_LT((scale.motion().stretch - Mat3(Vec3(1, 1.25, 1.25).asDiagonal())).norm(), 1e-12);
  for (const int key : {int('2'), int('.'), int('5')}) EXPECT_TRUE(scale.press(key, 0));
  EXPECT_EQ(scale.motion().stretch, Mat3(Vec3(1, 2.5, 2.5).asDiagonal()));
  EXPECT_EQ(scale.text(), "YZ × [2.5]");
  EXPECT_TRUE(scale.press('Z', 0));
  EXPECT_EQ(scale.motion().stretch, Mat3(Vec3(1, 1, 2.5).asDiagonal()));
  EXPECT_TRUE(scale.press(key::escape, 0));
  EXPECT_EQ(scale.motion()({1, 2, 3}), Vec3(1, 2, 3));

  Manipulation snap(scale_gizmo(), GizmoPart::Screen, {640, 160});
  snap.move_mouse({640, 113}, camera, picture, modifier::control);
  EXPECT_NEAR(snap.motion().stretch(1, 1), 1.2, 1e-12);
  Manipulation slow(scale_gizmo(), GizmoPart::Screen, {640, 160});
  slow.move_mouse({640, 60}, camera, picture, modifier::shift);
  EXPECT_NEAR(slow.motion().stretch(1, 1), 1.05, 1e-12);
}

TEST(EditorScale, AnyOrderOfDragsAddsUpAsTurnAndStretch) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> x(-1, 1);
  const Vec3 origin(5400000, 100, 0);
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 2, 0.5}, {0.3, 0.2, -1}};
  const Vec3 centre = (points[0] + points[1] + points[2] + points[3]) / 4;
  document::Motion motion;
  for (int i = 0; i < 40; ++i) {
    Transform by = turn_by(Vec3(x(random), x(random), x(random)).normalized(), i % 2 == 0 ? 100 * x(random) : 0,
                           {x(random), x(random), x(random)});
    if (i % 3 != 0) {
      const Mat3 axes = Eigen::AngleAxisd(x(random), Vec3(1, x(random), 2).normalized()).toRotationMatrix();
      const Mat3 S = axes * Vec3(1 + 0.4 * x(random), 1 + 0.4 * x(random), 1).asDiagonal() * axes.transpose();
      by.stretch = 0.5 * (S + S.transpose());
    }
    by.move = {x(random), 0, x(random)};
    const std::vector<Vec3> before = document::targets_of(motion, points, origin);
    motion = moved(motion, by, centre, origin);
    const std::vector<Vec3> after = document::targets_of(motion, points, origin);
    for (std::size_t k = 0; k < points.size(); ++k)
      ASSERT_LT((after[k] - by(before[k])).norm(), 1e-7 * (1 + after[k].norm())) << i;
    if (!motion.matrix) continue;
    const Mat3 A = motion.matrix->topLeftCorner<3, 3>();
    EXPECT_EQ(A, A.transpose());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Mat3>(A).eigenvalues().minCoeff(), 0);
    EXPECT_TRUE(document::turn_of(motion)) << "how far it is turned is lost";
  }

  const document::Motion large = moved({}, scale_by({2, 2, 2}, centre), centre, origin);
  EXPECT_FALSE(large.rotate);
  EXPECT_LT(large.move->norm(), 1e-12);
  const document::Motion back = moved(large, scale_by({0.5, 0.5, 0.5}, centre), centre, origin);
  EXPECT_FALSE(back.matrix) << "scaled there and back it is as it was";
  // Twice around and then scaled: still twice around.
  const document::Motion twice = moved({}, turn_by(Vec3::UnitX(), 720, centre), centre, origin);
  EXPECT_NEAR(moved(twice, scale_by({1, 3, 1}, centre), centre, origin).rotate->degrees, 720, 1e-9);
  const document::Motion wide = moved(large, turn_by(Vec3::UnitX(), 270, centre), centre, origin);
  EXPECT_NEAR(wide.rotate->degrees * wide.rotate->axis.x(), 270, 1e-9);
  // A mirror in a file stays one.
  document::Motion mirror;
  mirror.matrix = Eigen::Matrix4d::Identity();
  (*mirror.matrix)(0, 0) = -1;
  const Transform by = scale_by({1, 2, 1}, centre);
  const std::vector<Vec3> before = document::targets_of(mirror, points, {0, 0, 0});
  const std::vector<Vec3> after = document::targets_of(moved(mirror, by, centre, {0, 0, 0}), points, {0, 0, 0});
  for (std::size_t k = 0; k < points.size(); ++k) EXPECT_LT((after[k] - by(before[k])).norm(), 1e-12);
}

TEST(EditorScale, BetweenKeysTurnAndStretchAreInterpolatedEach) {
  const std::vector<Vec3> points{{1, 0, 0}, {-1, 0, 0}, {0, 0.5, 0}, {0, -0.5, 0}};
  const Vec3 centre(0, 0, 0), origin(10, 0, 0);
  document::Motion first;
  first.move = Vec3(0, 0, 0);
  const document::Motion second = moved(moved(first, turn_by(Vec3::UnitZ(), 180, centre), centre, origin),
                                        scale_by({3, 3, 3}, centre), centre, origin);
  const std::vector<Vec3> half = document::targets_between(first, second, 0.5, points, points, points, origin);
  // Half way: turned by 90 degrees and twice as large. The mean of the two ends is the middle, all in one point.
  const std::vector<Vec3> wanted{{0, 2, 0}, {0, -2, 0}, {-1, 0, 0}, {1, 0, 0}};
  for (std::size_t k = 0; k < points.size(); ++k) EXPECT_LT((half[k] - wanted[k]).norm(), 1e-9) << half[k].transpose();
}

TEST(EditorScale, AScaleOfWhatMovesIsAKey) {
  const TemporaryFolder folder;
  const Shape rest = samples::box({3, 10, 3}, {0.05, 0.05, 0.05});
  for (int frame = 1; frame <= 5; ++frame) {
    Shape shape = rest;
    for (Vec3& p : shape.positions) p.x() += 0.1 * frame;
    io::write(folder / ("walk.000" + std::to_string(frame) + ".ply"), shape, true);
  }
  Session session{sinew::methods()};
  session.open(folder / "walk.####.ply");
  ASSERT_TRUE(until(session, [&] { return session.has_input(); })) << errors_of(session);
  for (const bool top : {false, true}) {
    PointSet end(session.input()->size());
    for (std::size_t i = 0; i < end.size(); ++i) {
      const double y = session.input()->positions[i].y(), low = session.rest_bounds().min.y();
      if (top ? y > session.rest_bounds().max.y() - 0.01 : y < low + 0.01) end.add(i);
    }
    session.select(end, SelectMode::Replace);
    session.mark_selection(top ? Mark::Handle : Mark::Fixed);
  }
  ASSERT_TRUE(settle(session));
  for (const auto& [frame, factor] : {std::pair(1, 1.0), std::pair(5, 2.0)}) {
    session.go_to_frame(frame);
    ASSERT_TRUE(until(session, [&] { return session.frame() == frame && !session.solving(); }));
    ASSERT_TRUE(session.begin_drag(0));
    Transform by = scale_by(Vec3::Constant(factor), session.handles()[0].target);
    by.move = {0, 0, 0.01};
    session.drag_to(by);
    session.end_drag();
    ASSERT_TRUE(settle(session));
  }
  ASSERT_EQ(errors_of(session), "");
  ASSERT_EQ(session.project().layers[0].keys.size(), 2u);
  EXPECT_FALSE(session.project().layers[0].keys[0].handles[0].matrix);
  ASSERT_TRUE(session.project().layers[0].keys[1].handles[0].matrix);
  session.go_to_frame(3);
  ASSERT_TRUE(until(session, [&] { return session.frame() == 3 && !session.solving(); }));
  const std::vector<document::Motion>& between = session.shown().front().motions;
  ASSERT_EQ(between.size(), 1u);
  EXPECT_LT((between[0].matrix->topLeftCorner<3, 3>() - 1.5 * Mat3::Identity()).norm(), 1e-12) << "half way";
}

class EditorScaledBox : public ::testing::TestWithParam<const char*> {};

TEST_P(EditorScaledBox, TheMethodTakesItAndTheFileSaysTheSame) {
  const TemporaryFolder folder;
  Session session{sinew::methods()};
  io::write(folder / "box.ply", samples::box({4, 14, 4}, {0.05, 0.05, 0.05}), true);
  session.open(folder / "box.ply");
  ASSERT_TRUE(until(session, [&] { return session.has_input(); })) << errors_of(session);
  session.add_layer(GetParam());
  const Bounds bounds = session.rest_bounds();
  const auto end = [&](bool top) {
    PointSet out(session.input()->size());
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double y = session.input()->positions[i].y();
      if (top ? y > bounds.max.y() - 0.08 : y < bounds.min.y() + 0.08) out.add(i);
    }
    return out;
  };
  session.select(end(false), SelectMode::Replace);
  session.mark_selection(Mark::Fixed);
  session.select(end(true), SelectMode::Replace);
  session.mark_selection(Mark::Handle);
  ASSERT_TRUE(settle(session));
  ASSERT_TRUE(session.begin_drag(0));
  const Vec3 pivot = session.handles()[0].target;
  session.drag_to(scale_by({1.6, 1, 1.6}, pivot));
  session.end_drag();
  ASSERT_TRUE(settle(session));
  ASSERT_EQ(errors_of(session), "");
  EXPECT_LT((session.handles()[0].target - pivot).norm(), 1e-9);
  // The handle is as wide as was asked for, and what lies between goes over to it.
  const std::vector<Vec3> bent(session.bent_positions().begin(), session.bent_positions().end());
  double handle_width = 0, middle_width = 0, rest_width = 0;
  for (std::size_t i = 0; i < bent.size(); ++i) {
    const Vec3& p = session.input()->positions[i];
    rest_width = std::max(rest_width, std::abs(p.x() - pivot.x()));
    if (p.y() > bounds.max.y() - 0.08) handle_width = std::max(handle_width, std::abs(bent[i].x() - pivot.x()));
    if (std::abs(p.y() - bounds.centre().y()) < 0.03)
      middle_width = std::max(middle_width, std::abs(bent[i].x() - pivot.x()));
  }
  // The graph's maps are to be rotations: it holds its handles softly against that.
  const double soft = std::string(GetParam()) == "graph" ? 0.2 : 0.03;
  EXPECT_NEAR(handle_width, 1.6 * rest_width, soft * rest_width);
  EXPECT_GT(middle_width, 0.9 * rest_width);
  EXPECT_LT(middle_width, 1.6 * rest_width);

  session.save_edit(folder / "edit.json");
  ASSERT_TRUE(until(session, [&] { return !session.dirty() && !session.job(); })) << errors_of(session);
  const document::Project project = document::read_edit(folder / "edit.json");
  EXPECT_TRUE(project == session.project()) << "the saved edit reads back as another";
  const auto line = document::evaluate(io::read(folder / "box.ply"), project.layers, sinew::methods());
  double apart = 0;
  for (std::size_t i = 0; i < bent.size(); ++i) apart = std::max(apart, (bent[i] - line.shape->positions[i]).norm());
  EXPECT_LE(apart, 1e-9);

  // What was part of the scaled handle is scaled as it was when it becomes one of its own.
  PointSet part(session.input()->size());
  for (const Index i : end(true).indices())
    if (session.input()->positions[i].x() > pivot.x()) part.add(i);
  session.select(part, SelectMode::Replace);
  session.mark_selection(Mark::Handle);
  ASSERT_TRUE(settle(session));
  EXPECT_TRUE(session.project().layers[0].handles[1].motion.matrix);
  double leapt = 0;
  part.each([&](std::size_t i) { leapt = std::max(leapt, (session.bent_positions()[i] - bent[i]).norm()); });
  EXPECT_LT(leapt, 0.03 * rest_width);
}

INSTANTIATE_TEST_SUITE_P(Methods, EditorScaledBox, ::testing::Values("graph", "tet", "shell"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace sinew::editor
