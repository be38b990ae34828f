#include "engine/geometry/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "engine/geometry/bounds.h"
#include "engine/geometry/error.h"

namespace sinew {

namespace {

/// A next random-looking double in [low, high].
double between(double low, double high, std::uint64_t& state) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return low + (high - low) * static_cast<double>(state >> 11) * 0x1p-53;
}

}  // namespace

TEST(Origin, IsZeroForShapesNearTheirOrigin) {
  EXPECT_EQ(choose_origin(Vec3(-1, 0, 2), Vec3(1, 3, 5)), Vec3(0, 0, 0));
  EXPECT_EQ(choose_origin(Vec3(0, 0, 0), Vec3(0, 0, 0)), Vec3(0, 0, 0));
}

TEST(Origin, ThereAndBackIsExactForEveryBit) {
  std::uint64_t state = 1;
  for (int shape_number = 0; shape_number < 200; ++shape_number) {
    const double far = std::pow(10, between(-3, 9, state)) * (shape_number % 2 == 0 ? 1 : -1);
    const double extent = std::pow(10, between(-4, 1, state)) * std::abs(far) / 10;
    Shape shape;
    for (int i = 0; i < 50; ++i)
      shape.positions.emplace_back(far + between(-extent, extent, state), between(-1, 1, state),
                                   2 * far + between(0, extent, state));
    const std::vector<Vec3> file = shape.positions;
    set_origin(shape);
    for (std::size_t i = 0; i < file.size(); ++i) {
      const Vec3 back = shape.positions[i] + shape.origin;
      EXPECT_EQ(std::memcmp(back.data(), file[i].data(), sizeof(Vec3)), 0);
    }
  }
}

TEST(Origin, KeepsAMillimetreInFloatAtUtmCoordinates) {
  Shape shape;
  for (int i = 0; i < 100; ++i) shape.positions.emplace_back(448000 + 0.001 * i, 5400000 + 0.5 * i, 120 + i);
  set_origin(shape);
  EXPECT_EQ(shape.origin.z(), 0);
  for (int i = 1; i < 100; ++i) {
    const auto a = static_cast<float>(shape.positions[i - 1].x()), b = static_cast<float>(shape.positions[i].x());
    EXPECT_NEAR(b - a, 0.001, 1e-6);
  }
}

TEST(Origin, PointsThatAreNotFiniteDoNotCount) {
  Shape shape;
  shape.positions = {Vec3(1e6, 0, 0), Vec3(1e6 + 1, 1, 1), Vec3(std::nan(""), 0, 0), Vec3(HUGE_VAL, 1, 1)};
  set_origin(shape);
  EXPECT_GT(shape.origin.x(), 9e5);
  shape = {};
  set_origin(shape);
  EXPECT_EQ(shape.origin, Vec3(0, 0, 0));
}

TEST(Representation, IsToldByFacesAndParts) {
  Shape shape;
  shape.positions.assign(6, Vec3::Zero());
  EXPECT_STREQ(representation(shape), "point cloud");
  const Index a[] = {0, 1, 2}, b[] = {3, 4, 5}, c[] = {2, 3, 4};
  shape.faces.add(a);
  shape.faces.add(b);
  EXPECT_STREQ(representation(shape), "polygon soup");
  shape.faces.add(c);
  EXPECT_STREQ(representation(shape), "mesh");
  shape.parts.resize(2);
  EXPECT_STREQ(representation(shape), "scan set");
}

TEST(Attribute, NumbersGoInAndOutOfEveryType) {
  for (const Type type : {Type::Int8, Type::UInt8, Type::Int16, Type::UInt16, Type::Int32, Type::UInt32, Type::Int64,
                          Type::UInt64, Type::Float32, Type::Float64}) {
    Attribute a;
    a.type = type;
    a.components = 2;
    a.values.resize(3 * a.row_size());
    EXPECT_EQ(a.count(), 3u);
    a.set_number(1, 1, 100);
    EXPECT_EQ(a.number(1, 1), 100) << name_of(type);
    EXPECT_EQ(a.number(1, 0), 0);
    const bool real = type == Type::Float32 || type == Type::Float64;
    a.set_number(2, 0, 7.6);
    EXPECT_NEAR(a.number(2, 0), real ? 7.6 : 8, 1e-6) << name_of(type);
    if (real) continue;
    // Integers take the nearest value that they have; NaN is zero.
    for (const double extreme : {1e300, -1e300, std::numeric_limits<double>::infinity()}) {
      a.set_number(0, 0, extreme);
      EXPECT_EQ(a.number(0, 0) > 0, extreme > 0) << name_of(type);
    }
    a.set_number(0, 0, std::nan(""));
    EXPECT_EQ(a.number(0, 0), 0);
  }
}

TEST(Sequence, AStillHasOneFrame) {
  const auto shape = std::make_shared<Shape>();
  const Sequence sequence = still(shape);
  EXPECT_EQ(sequence.frames, std::vector<int>{1});
  EXPECT_EQ(sequence.load(1), shape);
}

TEST(Error, NamesThePlace) {
  EXPECT_STREQ(text_error("a.ply", 3, 7, "a number", "\"x\"").what(), "a.ply:3:7: expected a number, found \"x\"");
  EXPECT_STREQ(text_error("a.ply", 3, 0, "a number", "nothing").what(), "a.ply:3: expected a number, found nothing");
  EXPECT_STREQ(byte_error("a.ply", 12, "4 bytes", "2").what(), "a.ply: byte 12: expected 4 bytes, found 2");
  EXPECT_EQ(sinew::quoted("a\x01\xff"), "\"a\\x01\\xff\"");
  EXPECT_LT(sinew::quoted(std::string(1000, 'x')).size(), 60u);
}

TEST(Bounds, NormalizationMakesTheDiagonalOne) {
  const std::vector<Vec3> points = {Vec3(10, 20, 30), Vec3(13, 24, 42), Vec3(std::nan(""), 0, 0)};
  const Bounds bounds = bounds_of(points);
  EXPECT_DOUBLE_EQ(bounds.diagonal(), 13);
  const Normalization unit = normalization_of(bounds);
  EXPECT_NEAR((unit.apply(points[1]) - unit.apply(points[0])).norm(), 1, 1e-15);
  EXPECT_LT((unit.undo(unit.apply(points[1])) - points[1]).norm(), 1e-13);
  EXPECT_TRUE(Bounds().empty());
  EXPECT_EQ(normalization_of(Bounds()).scale, 1);
}

}  // namespace sinew
