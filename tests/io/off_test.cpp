#include "engine/io/off.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/io/file_checks.h"
#include "tests/shared_data.h"

namespace sinew::io {
namespace {

const char* const everything =
    "  STCNOFF # with all of it\r\n"
    "# counts next\n"
    "3\n 2 # faces\n 7\n"
    "0.50 0 0  0 0 1  255 0 10 128  0 1 # first\n"
    "1 0 0  0 0\n 1.0  255 0 10 128\n0 1\n"
    "1 1 -1e-2  0 1 0  0 0 0 0  .5 .5\n"
    "\n3 0 1\n 2  0.5 0.5 1 # red\n"
    "2 0 1";

TEST(Off, ReadsAllSortsOfPoints) {
  const Shape shape = read_text(read_off, everything);
  expect_sound(shape, "everything");
  ASSERT_EQ(shape.size(), 3u);
  EXPECT_EQ(shape.positions[2], Vec3(1, 1, -0.01f));
  EXPECT_EQ(shape.faces.points, (std::vector<Index>{0, 1, 2}));
  ASSERT_TRUE(shape.find("normal") && shape.find("color"));
  EXPECT_EQ(shape.find("normal")->number(2, 1), 1);
  EXPECT_EQ(shape.find("color")->type, Type::UInt8);
  EXPECT_EQ(shape.find("color")->number(1, 3), 128);
  EXPECT_EQ(shape.notes, (std::vector<std::string>{"Kept in the OFF file only: 3 texture coordinates.",
                                                   "Kept in the OFF file only: 1 colour of a face.",
                                                   "Kept in the OFF file only: 1 face of fewer than three corners."}));
}

TEST(Off, GivesTheSameBytesBack) {
  EXPECT_EQ(write_text(write_off, read_text(read_off, everything)), everything);
}

TEST(Off, ReplacesOnlyTokensThatChanged) {
  Shape shape = read_text(read_off, everything);
  shape.positions[0].x() = 0.75;
  shape.positions[2].z() = 4;
  shape.find("normal")->set_number(1, 2, -1);
  shape.find("color")->set_number(1, 2, 99);
  std::string expected = everything;
  for (const auto& [old, now] : {std::pair<std::string, std::string>{"0.50 ", "0.75 "},
                                 {"-1e-2", "4"},
                                 {" 1.0 ", " -1 "},
                                 {" -1  255 0 10", " -1  255 0 99"}}) {
    ASSERT_NE(expected.find(old), std::string::npos) << old;
    expected.replace(expected.find(old), old.size(), now);
  }
  EXPECT_EQ(write_text(write_off, shape), expected);
}

TEST(Off, KeywordMayBeMissingAndCountsMayFollowIt) {
  EXPECT_EQ(read_text(read_off, "1 0 0\n1 2 3").size(), 1u);
  EXPECT_EQ(read_text(read_off, "OFF 1 0 0 1 2 3 and more").notes,
            std::vector<std::string>{"Kept in the OFF file only: text behind the last face."});
  EXPECT_EQ(read_text(read_off, "OFF 0 0 0").size(), 0u);
}

TEST(Off, ColorsAreBytesOrFractions) {
  const Shape bytes = read_text(read_off, "COFF\n1 0 0\n1 2 3 0 255 7\n");
  ASSERT_TRUE(bytes.find("color"));
  EXPECT_EQ(bytes.find("color")->components, 3);
  EXPECT_EQ(bytes.find("color")->type, Type::UInt8);
  const Shape ones = read_text(read_off, "COFF\n1 0 0\n1 2 3 0 1 1 1\n");
  EXPECT_EQ(ones.find("color")->type, Type::Float32);
  EXPECT_EQ(ones.find("color")->components, 4);
  const Shape above = read_text(read_off, "COFF\n1 0 0\n1 2 3 0 256 1 1\n");
  EXPECT_EQ(above.find("color")->type, Type::Float32);
}

TEST(Off, KeepsAMillimetreFarFromTheOrigin) {
  Shape shape = read_text(read_off, "OFF\n2 0 0\n5400000 500000 12\n5400001 500001 13\n");
  shape.positions[1].x() += 0.001;
  EXPECT_EQ(write_text(write_off, shape), "OFF\n2 0 0\n5400000 500000 12\n5400001.001 500001 13\n");
}

TEST(Off, RefusesInOneSentence) {
  struct Case {
    const char* text;
    const char* sentence;
  };
  const Case cases[] = {
      {"", "test: expected text in ASCII or UTF-8, found an empty file"},
      {"# only this", "test:1:12: expected OFF or a keyword that ends in OFF, found the end of the file"},
      {"ply\n", "test:1:1: expected OFF or a keyword that ends in OFF, found \"ply\""},
      {"OFF8 1 0 0\n", "test:1:1: expected OFF or a keyword that ends in OFF, found \"OFF8\""},
      {"OFF BINARY\n1 0 0", "test:1: expected OFF in text, found the keyword BINARY"},
      {"4OFF\n1 0 0", "test:1:1: expected OFF with points of three coordinates, found \"4OFF\""},
      {"nOFF\n5\n1 0 0", "test:1:1: expected OFF with points of three coordinates, found \"nOFF\""},
      {"NCOFF\n1 0 0", "test:1:1: expected OFF with a prefix of ST, C and N, found \"NCOFF\""},
      {"OFF\n-1 0 0", "test:2:1: expected the count of points, found \"-1\""},
      {"OFF\n1.5 0 0", "test:2:1: expected the count of points, found \"1.5\""},
      {"OFF\n353535235358 6 0\n",
       "test:2:1: expected a count of points that fits into the 5 bytes left, found \"353535235358\""},
      {"OFF\n0 9 0\n", "test:2:3: expected a count of faces that fits into the 3 bytes left, found \"9\""},
      {"OFF\n0 0", "test:2:4: expected the count of edges, found the end of the file"},
      {"OFF\n2 0 0\n0 0 0\n0 0", "test:4:4: expected a number of point 2 of 2, found the end of the file"},
      {"OFF\n1 0 0\n0 1.#IND 0", "test:3:3: expected a number of point 1 of 1, found \"1.#IND\""},
      {"OFF\n1 1 0\n0 0 0\nx 0 0", "test:4:1: expected the count of corners of face 1 of 1, found \"x\""},
      {"OFF\n1 1 0\n0 0 0\n4000000000 0 0",
       "test:4:1: expected a count of corners that fits into the 4 bytes left, found \"4000000000\""},
      {"OFF\n1 1 0\n0 0 0\n3 0 0 1",
       "test:4:7: expected an index from 0 of one of 1 points, in face 1 of 1, found \"1\""},
      {"OFF\n1 1 0\n0 0 0\n3 0 0 -1",
       "test:4:7: expected an index from 0 of one of 1 points, in face 1 of 1, found \"-1\""},
      {"OFF\n1 1 0\n0 0 0\n1 ", "test:4:1: expected a count of corners that fits into the 1 bytes left, found \"1\""},
  };
  for (const Case& c : cases) EXPECT_EQ(refusal(read_off, c.text), c.sentence) << c.text;
}

TEST(Off, WritesWhatAnotherFormatHeld) {
  Shape shape;
  shape.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0.1f)};
  shape.faces.add(std::vector<Index>{0, 1, 2});
  Attribute color{"color", {"rgb"}, Kind::Color, Type::UInt32, 1, {}, {}, {}};
  color.values = bytes_of("\x01\x33\xff\x05\x01\x33\xff\x05\x01\x33\xff\x05");
  Attribute normal{"normal", {"x", "y", "z"}, Kind::Normal, Type::Float32, 3, {}, {}, {}};
  normal.values.resize(36);
  Attribute label{"label", {"label"}, Kind::Id, Type::UInt8, 1, {}, {}, {}};
  label.values.resize(3);
  shape.attributes = {color, normal, label};
  const std::string text =
      "CNOFF\n3 1 0\n0 0 0 0 0 0 255 51 1 255\n1 0 0 0 0 0 255 51 1 255\n0 1 0.1 0 0 0 255 51 1 255\n3 0 1 2\n";
  EXPECT_EQ(write_text(write_off, shape), text);
  EXPECT_EQ(lost(write_off, shape), std::vector<std::string>{"OFF cannot hold the attribute \"label\"."});
  EXPECT_EQ(write_text(write_off, read_text(read_off, text)), text);
}

TEST(Off, DamagedFilesAreRefusedOrExact) {
  SHARED_DATA(folder, "malformed");
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".off") {
      expect_refused_or_exact(read_off, write_off, entry.path().string());
      ++files;
    }
  EXPECT_GE(files, 4);
}

TEST(Off, RealFilesComeBackExactly) {
  for (const char* name : {"meshes", "deform_benchmark"}) {
    SHARED_DATA(folder, name);
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".off") continue;
      ++files;
      expect_exact(read_off, write_off, entry.path().string());
    }
    EXPECT_GT(files, 0) << name;
  }
}

}  // namespace
}  // namespace sinew::io
