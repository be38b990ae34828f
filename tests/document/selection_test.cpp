#include "engine/document/selection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>

#include "engine/geometry/error.h"
#include "tests/document/toy_method.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew::document {

namespace {

/// 10 x 10 points of a unit grid at `origin`, the file's coordinates being origin + (x, y, 0); point 99 is not finite.
std::shared_ptr<const Shape> grid(const Vec3& origin = Vec3::Zero()) {
  auto shape = std::make_shared<Shape>();
  shape->origin = origin;
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x) shape->positions.emplace_back(x, y, 0);
  shape->positions[99].x() = std::numeric_limits<double>::quiet_NaN();
  return shape;
}

Selection select(auto what) {
  Selection selection;
  selection.what = std::move(what);
  selection.place.text = "e.json:1:2";
  return selection;
}

std::string message_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST(Selection, EachKindAtAnyOrigin) {
  for (const Vec3& o : {Vec3(0, 0, 0), Vec3(5400000, 400000, 100)}) {
    Selector selector(grid(o));
    EXPECT_EQ(selector.points(select(SelectAll{})).size(), 99u);  // without the point that is not finite
    EXPECT_EQ(selector.points(select(SelectIndices{Shared<Index>({7, 3, 7})})), (std::vector<Index>{3, 7}));
    EXPECT_EQ(selector.points(select(SelectBox{o + Vec3(1, 1, 0), o + Vec3(2, 2, 0)})),
              (std::vector<Index>{11, 12, 21, 22}));
    EXPECT_EQ(selector.points(select(SelectSphere{o + Vec3(5, 5, 0), 1})), (std::vector<Index>{45, 54, 55, 56, 65}));
    EXPECT_EQ(selector.points(select(SelectNearest{o + Vec3(3.5, 4.1, 7)})),
              (std::vector<Index>{43}));  // of two the lower
  }
}

TEST(Selection, Components) {
  auto shape = std::make_shared<Shape>(*grid());
  shape->positions[99].x() = 9;
  shape->faces.add(std::vector<Index>{0, 1, 2});
  shape->faces.add(std::vector<Index>{5, 6, 7});
  Selector selector(shape);
  EXPECT_EQ(selector.points(select(SelectComponent{0})), (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(selector.points(select(SelectComponent{3})), (std::vector<Index>{5, 6, 7}));
  EXPECT_EQ(message_of([&] { selector.points(select(SelectComponent{96})); }),
            "e.json:1:2: expected a component below 96, found 96");
}

TEST(Selection, Labels) {
  const TemporaryFolder folder;
  const std::string path = folder / "labels.sel";
  std::ofstream(path) << "# one a point\n0 1\n1 # to the end of the line 5\n-3\r\n2\n";
  Selector selector(line_of_points(5));
  EXPECT_EQ(selector.points(select(SelectLabels{path, 1})), (std::vector<Index>{1, 2}));
  EXPECT_EQ(selector.points(select(SelectLabels{path, -3})), (std::vector<Index>{3}));
  EXPECT_EQ(message_of([&] {
              selector.points(select(SelectLabels{path, 9}));
            }),
            "e.json:1:2: expected a selection of at least one point, found none");
  Selector longer(line_of_points(6));
  EXPECT_EQ(message_of([&] {
              longer.points(select(SelectLabels{path, 1}));
            }),
            path + ": expected 6 labels, one a point, found 5");
  std::ofstream(path) << "0\n1.5\n";
  Selector broken(line_of_points(2));
  EXPECT_EQ(message_of([&] {
              broken.points(select(SelectLabels{path, 1}));
            }),
            path + ":2:1: expected a whole number, the label of a point, found \"1.5\"");
  EXPECT_NE(message_of([&] {
              broken.points(select(SelectLabels{path + "-none", 1}));
            }).find("No such file"),
            std::string::npos);
}

TEST(Selection, LabelsOfTheBenchmark) {
  SHARED_DATA(path, "deform_benchmark/bar.sel");
  Selector selector(line_of_points(6084));
  const std::size_t fixed = selector.points(select(SelectLabels{path.string(), 0})).size();
  const std::size_t free = selector.points(select(SelectLabels{path.string(), 1})).size();
  const std::size_t handle = selector.points(select(SelectLabels{path.string(), 2})).size();
  EXPECT_EQ(fixed + free + handle, 6084u);
  EXPECT_GT(fixed, 0u);
  EXPECT_GT(handle, 0u);
}

TEST(Selection, IndicesBeyondThePointsOrNotFiniteAreRefused) {
  Selector selector(grid());
  EXPECT_EQ(message_of([&] {
              selector.points(select(SelectIndices{Shared<Index>({0, 100})}));
            }),
            "e.json:1:2: expected indices below 100, the number of points, found 100");
  EXPECT_EQ(message_of([&] { selector.points(select(SelectIndices{Shared<Index>({99})})); }),
            "e.json:1:2: expected points with finite coordinates, found point 99 without");
  EXPECT_EQ(message_of([&] {
              selector.points(select(SelectBox{Vec3(20, 0, 0), Vec3(30, 1, 1)}));
            }),
            "e.json:1:2: expected a selection of at least one point, found none");
}

TEST(Constraints, TargetsKeepTheOrderOfTheIndices) {
  Layer layer;
  HandleEdit handle;
  handle.points = select(SelectIndices{Shared<Index>({4, 2})});
  handle.motion.to = Shared<Vec3>({Vec3(40, 0, 0), Vec3(20, 0, 0)});
  handle.place.text = "e.json:3:4";
  layer.handles = {handle};
  const auto shape = line_of_points(5, Vec3(1, 0, 0));
  Selector selector(shape);
  const Constraints constraints = selector.constraints(layer, shape->positions);
  ASSERT_EQ(constraints.handles.size(), 1u);
  EXPECT_EQ(constraints.handles[0].points, (std::vector<Index>{4, 2}));
  EXPECT_EQ(constraints.handles[0].targets[0], Vec3(39, 0, 0));

  layer.handles[0].motion.to = Shared<Vec3>({Vec3(40, 0, 0)});
  EXPECT_EQ(message_of([&] { selector.constraints(layer, shape->positions); }),
            "e.json:3:4: expected 2 targets in \"to\", one a point, found 1");
  layer.handles[0].points = select(SelectIndices{Shared<Index>({2, 4, 2})});
  EXPECT_EQ(message_of([&] { selector.constraints(layer, shape->positions); }),
            "e.json:1:2: expected each index once, because \"to\" has a target for each, found 2 again");
}

TEST(Constraints, APointBelongsToOneHandleOnly) {
  Layer layer;
  HandleEdit first, second;
  first.points = select(SelectIndices{Shared<Index>({0, 1})});
  second.points = select(SelectIndices{Shared<Index>({1, 2})});
  second.place.text = "e.json:5:6";
  first.motion.move = second.motion.move = Vec3(1, 0, 0);
  layer.handles = {first, second};
  const auto shape = line_of_points(5);
  Selector selector(shape);
  EXPECT_EQ(message_of([&] { selector.constraints(layer, shape->positions); }),
            "e.json:5:6: expected points of this handle alone, found point 1, which is also one of handle 1");
  layer.handles = {second};
  layer.fixed = {select(SelectIndices{Shared<Index>({2})})};
  EXPECT_EQ(message_of([&] { selector.constraints(layer, shape->positions); }),
            "e.json:5:6: expected points of this handle alone, found point 2, which is also one of the fixed");
}

TEST(Motion, TurnsThenMatrixThenMove) {
  Motion motion;
  motion.rotate = Rotation{Vec3(0, 0, 3), 90, Vec3(1, 0, 0)};
  motion.matrix = Eigen::Matrix4d::Identity();
  motion.matrix->diagonal() = Eigen::Vector4d(2, 2, 2, 1);
  motion.move = Vec3(0, 0, 1);
  const Vec3 p(2, 0, 0);
  const std::vector<Vec3> out = targets_of(motion, std::span(&p, 1), Vec3(0, 0, 0));
  EXPECT_NEAR((out[0] - Vec3(2, 2, 1)).norm(), 0, 1e-15);  // (1, 1, 0), doubled, lifted
}

TEST(Motion, WithoutAboutTurnsAboutTheMean) {
  Motion motion;
  motion.rotate = Rotation{Vec3(0, 0, 1), 180, {}};
  const std::vector<Vec3> points{Vec3(1, 0, 0), Vec3(3, 0, 0)};
  const std::vector<Vec3> out = targets_of(motion, points, Vec3(7, 7, 7));
  EXPECT_NEAR((out[0] - points[1]).norm(), 0, 1e-15);
}

TEST(Motion, FileCoordinatesAndOriginAgree) {
  // The same motion of the same points, once with everything in the origin, once without one.
  const Vec3 origin(5400000, 400000, 0), p(1.5, 2.25, 3);
  const Vec3 absolute = p + origin;
  Motion motion;
  motion.rotate = Rotation{Vec3(1, 2, 3), 50, origin + Vec3(1, 1, 1)};
  motion.matrix = Eigen::Matrix4d::Identity();
  (*motion.matrix)(0, 3) = 0.25;
  motion.move = Vec3(0, 0.5, 0);
  const Vec3 relative = targets_of(motion, std::span(&p, 1), origin)[0];
  const Vec3 whole = targets_of(motion, std::span(&absolute, 1), Vec3(0, 0, 0))[0];
  EXPECT_NEAR((relative + origin - whole).norm(), 0, 4e-9);
  Motion to;
  to.to = Shared<Vec3>({Vec3(5400001, 400002, 3)});
  EXPECT_EQ(targets_of(to, std::span(&p, 1), origin)[0], Vec3(1, 2, 3));
}

TEST(Motion, UnitMotionsKeepEveryBit) {
  const Vec3 p(0.1, 0.2, 0.3);
  Motion motion;
  motion.matrix = Eigen::Matrix4d::Identity();
  motion.move = Vec3(0, 0, 0);
  EXPECT_EQ(targets_of(motion, std::span(&p, 1), Vec3(5400000, 1, 2))[0], p);
}

}  // namespace sinew::document
