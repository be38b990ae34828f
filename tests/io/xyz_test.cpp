#include "engine/io/xyz.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/io/file_checks.h"

namespace sinew::io {
namespace {

std::string describe(const Shape& shape) {
  std::string out;
  for (const Attribute& a : shape.attributes)
    out += a.name + ":" + name_of(a.kind) + ":" + name_of(a.type) + ":" + std::to_string(a.components) + " ";
  return out;
}

std::string meaning(std::string_view text) {
  const Shape shape = read_text(read_xyz, text);
  expect_sound(shape, std::string(text));
  return describe(shape);
}

const char* const odd_but_good =
    "\xef\xbb\xbf// exported ;\r\n"
    "\r\n"
    "//X Y Z R G B \"Intensity\" label\r\n"
    " 3 \r\n"
    "  1.50, 2 ;3\t255 0 10  0.25 7 # the first\r\n"
    "# between\r\n"
    "+1,2,3,1,2,3,nan,8\r"
    "-1e1 2e0 3. 1 2 3 -0 9;";

TEST(Xyz, ReadsNamedColumns) {
  const Shape shape = read_text(read_xyz, odd_but_good);
  expect_sound(shape, "odd");
  ASSERT_EQ(shape.size(), 3u);
  EXPECT_EQ(shape.positions[2] + shape.origin, Vec3(-10, 2, 3));
  EXPECT_EQ(describe(shape), "color:color:uint8:3 Intensity:scalar:float32:1 label:id:float32:1 ");
  EXPECT_EQ(shape.find("label")->number(2, 0), 9);
  EXPECT_EQ(shape.find("color")->fields, (std::vector<std::string>{"R", "G", "B"}));
}

TEST(Xyz, GivesTheSameBytesBack) {
  EXPECT_EQ(write_text(write_xyz, read_text(read_xyz, odd_but_good)), odd_but_good);
}

TEST(Xyz, ReplacesOnlyFieldsThatChanged) {
  Shape shape = read_text(read_xyz, odd_but_good);
  shape.positions[0].x() = 1.75;
  shape.positions[2].z() = -4 - shape.origin.z();
  shape.find("color")->set_number(0, 2, 11);
  shape.find("Intensity")->set_number(1, 0, 0.5);
  std::string expected = odd_but_good;
  for (const auto& [old, now] :
       {std::pair<std::string, std::string>{"1.50,", "1.75,"}, {" 3. ", " -4 "}, {" 10 ", " 11 "}, {"nan", "0.5"}}) {
    ASSERT_NE(expected.find(old), std::string::npos) << old;
    expected.replace(expected.find(old), old.size(), now);
  }
  EXPECT_EQ(write_text(write_xyz, shape), expected);
}

TEST(Xyz, MeaningOfColumnsWithoutNames) {
  EXPECT_EQ(meaning("1 2 3"), "");
  EXPECT_EQ(meaning("1 2 3 4"), "intensity:scalar:float32:1 ");
  EXPECT_EQ(meaning("1 2 3 4 5"), "column 4:scalar:float32:1 column 5:scalar:float32:1 ");
  EXPECT_EQ(meaning("1 2 3 0 0.6 0.8\n1 2 3 0 0 0\n1 2 3 nan nan nan"), "normal:normal:float32:3 ");
  EXPECT_EQ(meaning("1 2 3 0 0.6 0.8\n1 2 3 0 0 1.1"),
            "column 4:scalar:float32:1 column 5:scalar:float32:1 column 6:scalar:float32:1 ");
  EXPECT_EQ(meaning("1 2 3 255 0 7"), "color:color:uint8:3 ");
  EXPECT_EQ(meaning("1 2 3 256 0 7"), "column 4:scalar:float32:1 column 5:scalar:float32:1 column 6:scalar:float32:1 ");
  EXPECT_EQ(meaning("1 2 3 100 255 0 7"), "color:color:uint8:3 intensity:scalar:float32:1 ");
  EXPECT_EQ(meaning("1 2 3 100 255 9 0.5"), "color:color:uint8:3 column 7:scalar:float32:1 ");
  EXPECT_EQ(meaning("1 2 3 0 0 1 0.5"), "normal:normal:float32:3 column 7:scalar:float32:1 ");
  EXPECT_EQ(meaning("1 2 3 255 8 7 0.6 0.8 0"), "normal:normal:float32:3 color:color:uint8:3 ");
  EXPECT_EQ(meaning("1 2 3 0.6 0.8 0 255 8 7"), "normal:normal:float32:3 color:color:uint8:3 ");
}

TEST(Xyz, MeaningOfColumnsByName) {
  EXPECT_EQ(read_text(read_xyz, "i,Z,Y,X\n9,3,2,1\n").origin, Vec3(1, 2, 3));
  EXPECT_EQ(meaning("i,Z,Y,X\n9,3,2,1\n"), "i:scalar:float32:1 ");
  EXPECT_EQ(meaning("# x y z Rf Gf Bf\n0 0 0 1 0 1\n"), "color:color:float32:3 ");
  EXPECT_EQ(meaning("# x y z Red Green Blue Alpha\n0 0 0 1 0 1 0\n"), "color:color:uint8:4 ");
  EXPECT_EQ(meaning("# x y z normal_x normal_y normal_z x\n0 0 0 5 5 5 1\n"),
            "normal:normal:float32:3 x:scalar:float32:1 ");
  EXPECT_EQ(meaning("# x y z nx ny normal normal\n0 0 0 5 5 5 1\n"),
            "nx:scalar:float32:1 ny:scalar:float32:1 normal 2:scalar:float32:1 normal 3:scalar:float32:1 ");
  // Names that are not as many as the columns are only a comment.
  EXPECT_EQ(meaning("# x y z a\n0 0 0\n"), "");
}

TEST(Xyz, VelocitiesByName) {
  EXPECT_EQ(meaning("# x y z Vx vY vz\n0 0 0 1 2 3\n"), "velocity:velocity:float32:3 ");
  EXPECT_EQ(meaning("velocity_x,velocity_y,velocity_z,x,y,z\n1,2,3,0,0,0\n"), "velocity:velocity:float32:3 ");
  EXPECT_EQ(meaning("x y z velocity vx vy vz\n0 0 0 9 1 2 3\n"),
            "velocity:velocity:float32:3 velocity 2:scalar:float32:1 ");
}

const char* const odd_csv =
    "\"id\",\"Z\", vx ,vz,vy,my speed, \"an, odd one\" ,y,x\r\n"
    "7,3,0.10,0.3,0.2,1,\"2.50\",2,1\r\n"
    "\"8\", 6, 1.10,1.3,1.2,-1,nan,5,4\n";

TEST(Xyz, CsvHasColumnsByNameInAnyOrder) {
  Shape shape = read_text(read_csv, odd_csv);
  expect_sound(shape, "csv");
  EXPECT_EQ(describe(shape),
            "velocity:velocity:float32:3 id:id:float32:1 my speed:scalar:float32:1 an, odd one:scalar:float32:1 ");
  EXPECT_EQ(shape.positions[1] + shape.origin, Vec3(4, 5, 6));
  EXPECT_EQ(shape.find("velocity")->number(1, 2), 1.3F);
  EXPECT_EQ(shape.find("id")->number(1, 0), 8);
  EXPECT_EQ(write_text(write_csv, shape), odd_csv);
  shape.find("an, odd one")->set_number(0, 0, 3);
  shape.find("velocity")->set_number(1, 0, 9);
  shape.find("id")->set_number(1, 0, 11);
  std::string expected = odd_csv;
  for (const auto& [old, now] :
       {std::pair<std::string, std::string>{"2.50", "3"}, {"1.10", "9"}, {"\"8\"", "\"11\""}}) {
    ASSERT_NE(expected.find(old), std::string::npos) << old;
    expected.replace(expected.find(old), old.size(), now);
  }
  EXPECT_EQ(write_text(write_csv, shape), expected);
  EXPECT_EQ(
      meaning("\"Points:0\",\"Points:1\",\"Points:2\",\"velocity:0\",\"velocity:1\",\"velocity:2\"\n1,2,3,4,5,6\n"),
      "velocity:velocity:float32:3 ");
}

TEST(Xyz, NamesThatAreNotAsManyAsTheColumnsAreRefused) {
  EXPECT_EQ(refusal(read_csv, "x,y,z,a b\n1,2,3\n"), "test:1: expected a name for each of the 3 columns, found 4");
  EXPECT_EQ(refusal(read_csv, "x,y,z\n1,2,3,4\n"), "test:1: expected a name for each of the 4 columns, found 3");
  EXPECT_EQ(refusal(read_csv, "x,y\n1,2\n"),
            "test:1:1: expected a number, or names of columns with x, y and z, found \"x\"");
  EXPECT_EQ(refusal(read_csv, "x,y,z\n1,,2\n"), "test:2:3: expected a number, found an empty field");
  EXPECT_EQ(refusal(read_csv, "x,y,z\n1,\"\",2\n"), "test:2:4: expected a number, found an empty field");
  EXPECT_EQ(refusal(read_csv, "x,y,z\n1,\"2,3\n"), "test:2:3: expected a number, found \"\"2\"");
}

TEST(Xyz, NewCsvHasCommasAndNames) {
  Shape shape = read_text(read_xyz, "# x y z vx vy vz id a/b\n1 2 3 4 5 6 7 8\n");
  const std::string text = "x,y,z,vx,vy,vz,id,a_b\n1,2,3,4,5,6,7,8\n";
  EXPECT_EQ(write_text(write_csv, shape), text);
  EXPECT_EQ(write_text(write_csv, read_text(read_csv, text)), text);
  EXPECT_EQ(write_text(write_xyz, read_text(read_csv, text)), "//X Y Z vx vy vz id a_b\n1 2 3 4 5 6 7 8\n");
  shape.faces.add(std::vector<Index>{0, 0, 0});
  EXPECT_EQ(lost(write_csv, shape), std::vector<std::string>{"CSV cannot hold the 1 face."});
}

TEST(Xyz, KeepsAMillimetreFarFromTheOrigin) {
  Shape shape = read_text(read_xyz, "5400000 500000 12\n5400001 500001 13\n");
  EXPECT_EQ(shape.position_type, Type::Float64);
  EXPECT_FALSE(shape.origin.isZero());
  shape.positions[1].x() += 0.001;
  EXPECT_EQ(write_text(write_xyz, shape), "5400000 500000 12\n5400001.001 500001 13\n");
}

TEST(Xyz, PointsFarOutsideComeBackExactly) {
  // The second coordinate belongs to a point that does not count for the origin, and is not representable relative to
  // it.
  const char* const text = "1000000.1 0 0\n1000000.3 0.1 0\nnan 1e-20 0\n1000000.2 -0 1e17\n";
  EXPECT_EQ(write_text(write_xyz, read_text(read_xyz, text)), text);
}

TEST(Xyz, RefusesInOneSentence) {
  struct Case {
    std::string text;
    const char* sentence;
  };
  const Case cases[] = {
      {"", "test: expected text in ASCII or UTF-8, found an empty file"},
      {"# x y z\n\n", "test: expected a row of at least three numbers, found none"},
      {"1 2 3\n1 2\n", "test:2: expected 3 numbers as in the rows above, found 2"},
      {"1 2 3\n1 2 3 4 5\n", "test:2: expected 3 numbers as in the rows above, found 5"},
      {"1 2\n", "test:1: expected at least three numbers in a row, found 2"},
      {"1 2 x\n", "test:1:5: expected a number, found \"x\""},
      {"1,,3\n", "test:1:3: expected a number, found an empty field"},
      {"Some title\n1 2 3\n", "test:1:1: expected a number, or names of columns with x, y and z, found \"Some\""},
      {"1 2 3\nx y z\n", "test:2:1: expected a number, found \"x\""},
      {"3\n1 2 3\n1 2 3\n", "test:1: expected the count of the 2 rows, found 3"},
      {"1\n1\n1 2 3\n", "test:2: expected at least three numbers in a row, found 1"},
      {"1 2 1.#QNAN\n", "test:1:5: expected a number, found \"1.#QNAN\""},
      {std::string("\xff\xfe") + "1",
       "test: byte 0: expected text in ASCII or UTF-8, found UTF-16 (by its byte order mark)"},
  };
  for (const Case& c : cases) EXPECT_EQ(refusal(read_xyz, c.text), c.sentence) << c.text;
  std::string wide;
  for (int i = 0; i < 257; ++i) wide += "1 ";
  EXPECT_EQ(refusal(read_xyz, wide), "test:1: expected at most 256 numbers in a row, found more");
  EXPECT_EQ(refusal(read_xyz, wide.substr(2)), "read");
}

TEST(Xyz, WritesWhatAnotherFormatHeld) {
  Shape shape;
  shape.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0.1f)};
  Attribute color{"color", {"red", "green", "blue"}, Kind::Color, Type::UInt8, 3, {}, {}, {}};
  color.values = bytes_of("\x01\x33\x02\x05\x01\x33");
  Attribute normal{"normal", {"x", "y", "z"}, Kind::Normal, Type::Float32, 3, {}, {}, {}};
  normal.values.resize(24);
  Attribute label{"label", {"label"}, Kind::Id, Type::UInt8, 1, {}, {}, {}};
  label.values = bytes_of("\x07\x09");
  Attribute odd{"odd one", {"odd #1"}, Kind::Scalar, Type::Float64, 1, {}, {}, {}};
  odd.values.resize(16);
  odd.set_number(1, 0, 0.1);
  Attribute pair{"pair", {"a", "b"}, Kind::Scalar, Type::UInt8, 2, {}, {}, {}};
  pair.values.resize(4);
  shape.attributes = {color, normal, label, odd, pair};
  shape.faces.add(std::vector<Index>{0, 1, 0});
  const std::string text = "//X Y Z R G B Nx Ny Nz label odd__1\n0 0 0 1 51 2 0 0 0 7 0\n1 0 0.1 5 1 51 0 0 0 9 0.1\n";
  EXPECT_EQ(write_text(write_xyz, shape), text);
  EXPECT_EQ(lost(write_xyz, shape),
            (std::vector<std::string>{"XYZ cannot hold the attribute \"pair\".", "XYZ cannot hold the 1 face."}));
  EXPECT_EQ(meaning(text), "normal:normal:float32:3 color:color:uint8:3 label:id:float32:1 odd__1:scalar:float32:1 ");
}

TEST(Xyz, RandomNumbersComeBackAndMovedOnesAreExact) {
  std::string text;
  unsigned state = 1;
  const auto random = [&] { return static_cast<double>((state = state * 1664525 + 1013904223) >> 8) / (1 << 24); };
  char row[128];
  for (int i = 0; i < 2000; ++i) {
    const char* const formats[] = {"%.9g %.3f %e\n", "%g,%.17g;%f\n", "%.0f\t%.6f  %.15e \r\n"};
    std::snprintf(row, sizeof row, formats[i % 3], random() * 1e6, random() - 0.5, random() * 1e-6);
    text += row;
  }
  Shape shape = read_text(read_xyz, text);
  ASSERT_EQ(write_text(write_xyz, shape), text);
  for (Vec3& p : shape.positions) p = Vec3(random(), random() * 1e9, -random());
  const Shape again = read_text(read_xyz, write_text(write_xyz, shape));
  for (std::size_t i = 0; i < shape.size(); ++i)
    ASSERT_EQ(again.positions[i] + again.origin, shape.positions[i] + shape.origin) << i;
}

}  // namespace
}  // namespace sinew::io
