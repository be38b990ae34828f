#include "engine/io/obj.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <clocale>
#include <filesystem>

#include "tests/io/file_checks.h"
#include "tests/shared_data.h"

namespace sinew::io {
namespace {

const char* const odd_but_good =
    "\xef\xbb\xbf# a comment that ends with a backslash \\\r\n"
    "mtllib some file.mtl\n"
    "  v   0.10  0 0\t# the first\n"
    "v 1 0e0 0 1.0\n"
    "v 1 \\\n  1 \\\r\n -0.0\n"
    "vt 0 0\nvt 1 0\n"
    "vn 0 0 1\nvn 0 0 2 \n"
    "v 0 1 0\r"
    "g a b\\\n c\n"
    "usemtl f\n"
    "s off\n"
    "f 1/1/1 2/2/1 3/1/1 4/2/1\n"
    "f -4//2 -3//2\\\n -2//2 # three\n"
    "f 1 2 6\n"
    "l 1 2\np 1\n"
    "curv 0 1 1 2\n"
    "f 1 2\n\n\n"
    "v 5 5 5\nv 6 6 6";

TEST(Obj, ReadsPointsFacesAndSharedNormals) {
  const Shape shape = read_text(read_obj, odd_but_good);
  expect_sound(shape, "odd");
  ASSERT_EQ(shape.size(), 6u);
  EXPECT_EQ(shape.position_type, Type::Float32);
  EXPECT_EQ(shape.positions[0].x(), 0.1f);
  EXPECT_EQ(shape.positions[2], Vec3(1, 1, 0));
  EXPECT_EQ(shape.positions[5], Vec3(6, 6, 6));
  EXPECT_EQ(shape.faces.offsets, (std::vector<Index>{0, 4, 7, 10}));
  EXPECT_EQ(shape.faces.points, (std::vector<Index>{0, 1, 2, 3, 0, 1, 2, 0, 1, 5}));
  const Attribute* normal = shape.find("normal");
  ASSERT_TRUE(normal);
  EXPECT_EQ(normal->kind, Kind::Normal);
  EXPECT_EQ(normal->point_offsets, (std::vector<Index>{0, 4, 7}));
  EXPECT_EQ(normal->points, (std::vector<Index>{0, 1, 2, 3, 0, 1, 2}));
  EXPECT_EQ(normal->number(1, 2), 2);
  EXPECT_EQ(shape.notes, (std::vector<std::string>{
                             "Kept in the OBJ file only: 2 texture coordinates.",
                             "Kept in the OBJ file only: 1 use of a material.",
                             "Kept in the OBJ file only: 2 lines of groups and objects.",
                             "Kept in the OBJ file only: 2 line or point elements.",
                             "Kept in the OBJ file only: 1 face of fewer than three corners.",
                             "Kept in the OBJ file only: 1 unknown line, first \"curv\" in line 23.",
                         }));
}

TEST(Obj, GivesTheSameBytesBack) {
  EXPECT_EQ(write_text(write_obj, read_text(read_obj, odd_but_good)), odd_but_good);
}

TEST(Obj, ReplacesOnlyTokensThatChanged) {
  Shape shape = read_text(read_obj, odd_but_good);
  shape.positions[0].x() = 0.3f;
  shape.positions[2].z() = 1.0f / 3;
  shape.positions[5].y() = -7;
  shape.find("normal")->set_number(1, 0, 0.5);
  std::string expected = odd_but_good;
  const auto replace = [&](const std::string& old, const std::string& now) {
    const std::size_t at = expected.find(old);
    ASSERT_NE(at, std::string::npos) << old;
    expected.replace(at, old.size(), now);
  };
  replace("0.10 ", "0.3 ");
  replace("-0.0", "0.33333334");
  replace("v 6 6 6", "v 6 -7 6");
  replace("vn 0 0 2 ", "vn 0.5 0 2 ");
  EXPECT_EQ(write_text(write_obj, shape), expected);
}

TEST(Obj, NormalsOfPointsWithoutFacesBelongToThePoints) {
  const Shape shape = read_text(read_obj, "v 0 0 0\nvn 0 0 1\nv 1 0 0\nvn 0 1 0\n");
  ASSERT_TRUE(shape.find("normal"));
  EXPECT_TRUE(shape.find("normal")->per_point());
}

TEST(Obj, KeepsColorsOfAllPointsAndOfSome) {
  const Shape all = read_text(read_obj, "v 0 0 0 1 0.5 0.25\nv 1 0 0 nan 0 0\n");
  ASSERT_TRUE(all.find("color"));
  EXPECT_TRUE(all.find("color")->per_point());
  EXPECT_EQ(all.find("color")->number(0, 1), 0.5);
  EXPECT_EQ(all.find("color")->kind, Kind::Color);
  const Shape some = read_text(read_obj, "v 0 0 0\nv 1 0 0 1 2 3 4\nv 1 0 0 1 2 3\nv 1 2 3 4 5\n");
  ASSERT_TRUE(some.find("color"));
  EXPECT_EQ(some.find("color")->points, std::vector<Index>{1});
  EXPECT_EQ(some.find("color")->components, 4);
  EXPECT_EQ(some.notes,
            std::vector<std::string>{"Kept in the OBJ file only: 2 points with unknown numbers behind them."});
}

TEST(Obj, ReplacesColorsThatChanged) {
  Shape some = read_text(read_obj, "v 0 0 0\nv 1 0 0 1 2 3 # one\nv 2 0 0 1.0 2 3\n");
  some.find("color")->set_number(1, 1, 0.5);
  EXPECT_EQ(write_text(write_obj, some), "v 0 0 0\nv 1 0 0 1 2 3 # one\nv 2 0 0 1.0 0.5 3\n");
}

TEST(Obj, KeepsAMillimetreFarFromTheOrigin) {
  Shape shape = read_text(read_obj, "v 5400000 500000 12\nv 5400001 500001 13\nv 5400002 500000 12\nf 1 2 3\n");
  EXPECT_EQ(shape.position_type, Type::Float64);
  shape.positions[1].x() += 0.001;
  EXPECT_EQ(write_text(write_obj, shape),
            "v 5400000 500000 12\nv 5400001.001 500001 13\nv 5400002 500000 12\nf 1 2 3\n");
}

TEST(Obj, ChoosesFloatOnlyWhereNothingIsLost) {
  EXPECT_EQ(read_text(read_obj, "v 0.1 123.456 -1e-3").position_type, Type::Float32);
  EXPECT_EQ(read_text(read_obj, "v 0.333333343 0 0").position_type, Type::Float64);
  EXPECT_EQ(read_text(read_obj, "v 0.33333334 0 0").position_type, Type::Float32);
  EXPECT_EQ(read_text(read_obj, "v 0.3333333432674407958984375 0 0").position_type, Type::Float32);
  EXPECT_EQ(read_text(read_obj, "v 8192 0 0").position_type, Type::Float64);
  EXPECT_EQ(read_text(read_obj, "v nan -inf 0").position_type, Type::Float32);
}

TEST(Obj, RefusesInOneSentence) {
  struct Case {
    const char* text;
    const char* sentence;
  };
  const Case cases[] = {
      {"", "test: expected text in ASCII or UTF-8, found an empty file"},
      {"# nothing\n", "test: expected a line \"v x y z\", found none"},
      {"\xff\xfev\0", "test: byte 0: expected text in ASCII or UTF-8, found UTF-16 (by its byte order mark)"},
      {"v 1 2\n", "test:1:6: expected a number (z of a point), found the end of the line"},
      {"v 1 2 # 3\n", "test:1:7: expected a number (z of a point), found \"#\""},
      {"\n v 1 1.#IND 3\n", "test:2:6: expected a number (y of a point), found \"1.#IND\""},
      {"v 1 2 1e999\n", "test:1:7: expected a number (z of a point), found \"1e999\""},
      {"v 1 2 3 x\n", "test:1:9: expected a number (weight or colour of a point), found \"x\""},
      {"v 1 2 3\nvn 0 0 1,0\n", "test:2:8: expected a number (part of a normal), found \"1,0\""},
      {"v 0 0 0\nf 1 1 0\n", "test:2:7: expected the index of a point (1 to 1, or -1 to -1), found \"0\""},
      {"v 0 0 0\nf 1 1 -2\n", "test:2:7: expected the index of a point (1 to 1, or -1 to -1), found \"-2\""},
      {"f 1 3 2\nf 1 1 1\nv 0 0 0\nv 0 0 0\n",
       "test:1:5: expected the index of a point (1 to 2, or -2 to -1), found \"3\""},
      {"f -1 -1 -1\nv 0 0 0\n", "test:1:3: expected the index of a point, of which there are none, found \"-1\""},
      {"v 0 0 0\nf 1/1 1/1 1/1\n",
       "test:2:5: expected the index of a texture coordinate, of which there are none, found \"1\""},
      {"v 0 0 0\nvn 0 0 1\nf 1//1 1//2 1//1\n",
       "test:3:11: expected the index of a normal (1 to 1, or -1 to -1), found \"2\""},
      {"v 0 0 0\nf 1 1.5 1\n", "test:2:5: expected the index of a point (1 to 1, or -1 to -1), found \"1.5\""},
      {"v 0 0 0\nf 1 1 99999999999999999999\n",
       "test:2:7: expected the index of a point (1 to 1, or -1 to -1), found \"99999999999999999999\""},
      {"v 0 0 0\nf 1/1/1/1 1 1\n", "test:2:7: expected the index of a normal, of which there are none, found \"1/1\""},
      {"v 0 0 0\nf / / /\n",
       "test:2:3: expected the index of a point (1 to 1, or -1 to -1), found the end of the line"},
  };
  for (const Case& c : cases) EXPECT_EQ(refusal(read_obj, c.text), c.sentence) << c.text;
  using namespace std::string_view_literals;
  EXPECT_EQ(refusal(read_obj, "v 0 0 0\nv \0"sv), "test: byte 10: expected text in ASCII or UTF-8, found a zero byte");
}

TEST(Obj, WritesWhatAnotherFormatHeld) {
  Shape shape;
  shape.origin = Vec3(1000, 0, 0);
  shape.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0.1f)};
  shape.faces.add(std::vector<Index>{0, 1, 2});
  Attribute color{"color", {"red", "green", "blue"}, Kind::Color, Type::UInt8, 3, {}, {}, {}};
  color.values = bytes_of("\xff\x33\x01\xff\x33\x01\xff\x33\x01");
  Attribute facet{"normal", {"x", "y", "z"}, Kind::Normal, Type::Float32, 3, {}, {0, 3}, {0, 1, 2}};
  facet.values.resize(12);
  facet.set_number(0, 2, 1);
  Attribute label{"label", {"label"}, Kind::Id, Type::UInt8, 1, {}, {}, {}};
  label.values.resize(3);
  shape.attributes = {color, facet, label};
  EXPECT_EQ(write_text(write_obj, shape),
            "v 1000 0 0 1 0.2 0.003921569\nv 1001 0 0 1 0.2 0.003921569\nv 1000 1 0.1 1 0.2 0.003921569\n"
            "vn 0 0 1\nf 1//1 2//1 3//1\n");
  EXPECT_EQ(lost(write_obj, shape), std::vector<std::string>{"OBJ cannot hold the attribute \"label\"."});
}

TEST(Obj, ProgressCancels) {
  std::string text = "v 0 0 0\n";
  for (int i = 0; i < 100000; ++i) text += "v 1 2 3\n";
  ReadOptions options;
  double last = -1;
  options.progress = [&](double done) {
    EXPECT_GE(done, last);
    last = done;
    return done < 0.5;
  };
  EXPECT_THROW(read_obj("test", bytes_of(text), options), Cancelled);
  EXPECT_GT(last, 0.5);
}

TEST(Obj, DamagedFilesAreRefusedOrExact) {
  SHARED_DATA(folder, "malformed");
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".obj") {
      expect_refused_or_exact(read_obj, write_obj, entry.path().string());
      ++files;
    }
  EXPECT_GE(files, 15);
}

TEST(Obj, RealFilesComeBackExactly) {
  for (const char* name : {"soups", "meshes", "tets", "poses", "mocap", "anim"}) {
    SHARED_DATA(folder, name);
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".obj" || ++files > 12) continue;
      expect_exact(read_obj, write_obj, entry.path().string());
    }
    EXPECT_GT(files, 0) << name;
  }
}

}  // namespace
}  // namespace sinew::io
