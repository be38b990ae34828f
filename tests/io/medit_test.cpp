#include "engine/io/medit.h"

#include <gtest/gtest.h>

#include <fstream>

#include "engine/io/obj.h"
#include "engine/io/text_patch.h"
#include "tests/io/file_checks.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew::io {
namespace {

const char* const everything =
    "MeshVersionFormatted 2 # all of it\r\n\r\n"
    "Dimension\n3\n"
    "Vertices 5\n"
    "0.50 0 0 0\n1 0 0 7\n0 1 0 0 # third\n0 0 1.0 0\n1 1 -1e-2 -3\n"
    "Triangles\n1\n1 2 3 4\n"
    "Quadrilaterals\n1\n1 2 5 3 0\n"
    "Tetrahedra\n2\n1 2 3 4 0\n2 3 4 5 9\n"
    "Edges\n1\n1 2 0\n"
    "Corners\n0\n"
    "SubDomain 3\n1 1 1\n2 2 2\n3 3 3\n"
    "End\nmore 1 2";

std::string with(std::string_view rest) {
  return "MeshVersionFormatted 1\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n" + std::string(rest);
}

TEST(Medit, ReadsPointsFacesTetsAndLabels) {
  const Shape shape = read_text(read_medit, everything);
  expect_sound(shape, "everything");
  ASSERT_EQ(shape.size(), 5u);
  EXPECT_EQ(shape.positions[4], Vec3(1, 1, -0.01f));
  EXPECT_EQ(shape.faces.points, (std::vector<Index>{0, 1, 2, 0, 1, 4, 2}));
  EXPECT_EQ(shape.faces.offsets, (std::vector<Index>{0, 3, 7}));
  EXPECT_EQ(shape.tets, (std::vector<Tet>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_STREQ(representation(shape), "solid mesh");
  ASSERT_TRUE(shape.find("label"));
  EXPECT_EQ(shape.find("label")->kind, Kind::Id);
  EXPECT_EQ(shape.find("label")->number(4, 0), -3);
  EXPECT_EQ(shape.notes, (std::vector<std::string>{"Kept in the Medit file only: 1 reference of a face.",
                                                   "Kept in the Medit file only: 1 reference of a tet.",
                                                   "Kept in the Medit file only: sections \"Edges\", \"SubDomain\"."}));
}

TEST(Medit, LabelsThatAreAllZeroAreNoAttribute) {
  EXPECT_TRUE(read_text(read_medit, with("End")).attributes.empty());
}

TEST(Medit, TetsWoundTheOtherWayStayAsTheyAre) {
  const std::string text = with("Tetrahedra 1\n1 3 2 4 0\nEnd\n");
  const Shape shape = read_text(read_medit, text);
  EXPECT_EQ(shape.tets, (std::vector<Tet>{{0, 2, 1, 3}}));
  EXPECT_EQ(write_text(write_medit, shape), text);
}

TEST(Medit, ReplacesOnlyTokensThatChanged) {
  Shape shape = read_text(read_medit, everything);
  EXPECT_EQ(write_text(write_medit, shape), everything);
  shape.positions[0].x() = 0.75;
  shape.positions[4].z() = 4;
  shape.find("label")->set_number(1, 0, 100000);
  std::string expected = everything;
  for (const auto& [old, now] :
       {std::pair<std::string, std::string>{"0.50 ", "0.75 "}, {"-1e-2", "4"}, {"0 0 7", "0 0 100000"}}) {
    ASSERT_NE(expected.find(old), std::string::npos) << old;
    expected.replace(expected.find(old), old.size(), now);
  }
  EXPECT_EQ(write_text(write_medit, shape), expected);
}

TEST(Medit, RefusesInOneSentence) {
  struct Case {
    std::string text;
    const char* sentence;
  };
  const Case cases[] = {
      {"", "test: expected text in ASCII or UTF-8, found an empty file"},
      {std::string("\1\0\0\0\2\0\0\0", 8),
       "test: byte 0: expected Medit's text (.mesh), which programs that write .meshb can write too, found its binary "
       "form"},
      {"Vertices 1", "test:1:1: expected MeshVersionFormatted, found \"Vertices\""},
      {"MeshVersionFormatted 5", "test:1:22: expected a version of 1 to 4, found \"5\""},
      {"MeshVersionFormatted 1\nVertices 1\n", "test:2:1: expected Dimension, found \"Vertices\""},
      {"MeshVersionFormatted 1\nDimension 2\n", "test:2:11: expected the dimension 3, found \"2\""},
      {"MeshVersionFormatted 1\nDimension 3\nEnd\n", "test: expected a section Vertices, found none"},
      {"MeshVersionFormatted 1\nDimension 3\nVertices 4294967290\n0 0 0 0\n",
       "test:3:10: expected a count of points that fits into the 9 bytes left, found \"4294967290\""},
      {"MeshVersionFormatted 1\nDimension 3\nVertices -1\n", "test:3:10: expected the count of points, found \"-1\""},
      {"MeshVersionFormatted 1\nDimension 3\nVertices 2\n0 0 0 0\n0.0 0 0.0",
       "test:5:10: expected the reference (a whole number of 32 bits) of point 2 of 2, found the end of the file"},
      {"MeshVersionFormatted 1\nDimension 3\nVertices 1\n0 x 0 0\n",
       "test:4:3: expected a number of point 1 of 1, found \"x\""},
      {"MeshVersionFormatted 1\nDimension 3\nVertices 1\n0 0 0 0.5\n",
       "test:4:7: expected the reference (a whole number of 32 bits) of point 1 of 1, found \"0.5\""},
      {"MeshVersionFormatted 1\nDimension 3\nTetrahedra 1\n1 2 3 4 0\nVertices 1\n0 0 0 0\n",
       "test:4:1: expected points before tet 1 of 1, found \"1\""},
      {with("Vertices 1\n0 0 0 0\n"), "test:8:1: expected one section Vertices, found \"Vertices\""},
      {with("5 5\n"), "test:8:1: expected a keyword such as Tetrahedra or End, found \"5\""},
      {with("Triangles 1\n1 2 0 0\n"), "test:9:5: expected the index of a point (1 to 4) in face 1 of 1, found \"0\""},
      {with("Tetrahedra 1\n1 2 3 5 0\n"),
       "test:9:7: expected the index of a point (1 to 4) in tet 1 of 1, found \"5\""},
      {with("Tetrahedra 1\n1 2 3 1.0 0\n"),
       "test:9:7: expected the index of a point (1 to 4) in tet 1 of 1, found \"1.0\""},
      {with("Tetrahedra 1\n1 2 3 2 0\n"), "test:9:7: expected four different points in tet 1 of 1, found \"2\""},
      {with("Tetrahedra 2\n1 2 3 4 0\n"),
       "test:8:12: expected a count of tets that fits into the 11 bytes left, found \"2\""},
      {with("Tetrahedra 2\n1 2 3 4 0\n0 0 0 0 0"),
       "test:10:1: expected the index of a point (1 to 4) in tet 2 of 2, found \"0\""},
  };
  for (const Case& c : cases) EXPECT_EQ(refusal(read_medit, c.text), c.sentence) << c.text;
}

TEST(Medit, WritesWhatAnotherFormatHeld) {
  Shape shape = read_text(read_obj,
                          "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 0.5 0.1\nv 0 0 1\n"
                          "f 1 2 3\nf 1 2 3 4\nf 1 2 3 4 5\n");
  shape.tets = {{0, 1, 2, 5}};
  shape.attributes.push_back(
      number_attribute("label", {"label"}, Kind::Id, Type::UInt8, std::vector<double>{1, 2, 3, 4, 5, 6}));
  const std::string text =
      "MeshVersionFormatted 1\nDimension 3\nVertices\n6\n"
      "0 0 0 1\n1 0 0 2\n1 1 0 3\n0 1 0 4\n-1 0.5 0.1 5\n0 0 1 6\n"
      "Triangles\n4\n 1 2 3 0\n 1 2 3 0\n 1 3 4 0\n 1 4 5 0\n"
      "Quadrilaterals\n1\n 1 2 3 4 0\n"
      "Tetrahedra\n1\n 1 2 3 6 0\nEnd\n";
  EXPECT_EQ(write_text(write_medit, shape), text);
  EXPECT_EQ(lost(write_medit, shape),
            std::vector<std::string>{"Medit cannot hold 1 face of more than 4 corners: cut into triangles."});
  const Shape again = read_text(read_medit, text);
  EXPECT_EQ(again.tets, shape.tets);
  EXPECT_EQ(write_text(write_medit, again), text);
  // Labels too large for it are named, not cut.
  shape.find("label")->type = Type::Int64;
  shape.find("label")->values.assign(48, std::byte{0x7f});
  EXPECT_EQ(lost(write_medit, shape).front(), "Medit cannot hold the attribute \"label\".");
}

TEST(Medit, OtherTetsThanThoseOfTheFileAreANewFile) {
  Shape shape = read_text(read_medit, with("Tetrahedra 1\n1 2 3 4 5\nEnd\n"));
  shape.tets.push_back({0, 1, 2, 3});
  EXPECT_EQ(read_text(read_medit, write_text(write_medit, shape)).tets, shape.tets);
  EXPECT_EQ(lost(write_medit, shape),
            std::vector<std::string>{"What the Medit file held besides points, faces and tets is not written: they are "
                                     "no longer those of the file."});
}

TEST(Medit, OtherFormatsSayThatTetsAreLost) {
  const TemporaryFolder folder;
  const Shape shape = read_text(read_medit, everything);
  int said = 0, held = 0;
  for (const Format& format : formats()) {
    if (format.write == nullptr || format.write_beside != nullptr) continue;
    const std::string path = folder / ("a." + format.extensions.front());
    const std::vector<std::string> lost = write(path, shape).lost;
    const auto count = std::count(lost.begin(), lost.end(), format.name + " cannot hold 2 tets.");
    EXPECT_EQ(count, format.tets ? 0 : 1) << format.name;
    ++(format.tets ? held : said);
  }
  EXPECT_GE(said, 12);
  EXPECT_GE(held, 1);
}

TEST(Medit, RealFilesComeBackExactly) {
  SHARED_DATA(folder, "tets");
  struct File {
    const char* name;
    std::size_t points, faces, tets;
  };
  for (const File& file : {File{"bunny.mesh", 5433, 6966, 34055}, File{"hand_rig/hand.mesh", 7234, 9556, 29998},
                           File{"octopus-low.mesh", 452, 898, 1140}}) {
    const std::string path = (folder / file.name).string();
    expect_exact(read_medit, write_medit, path);
    const Shape shape = read_text(read_medit, text_of_file(path), path);
    EXPECT_EQ(shape.size(), file.points) << path;
    EXPECT_EQ(shape.faces.size(), file.faces) << path;
    EXPECT_EQ(shape.tets.size(), file.tets) << path;
    Shape fresh = shape;
    fresh.content = nullptr;
    const Shape again = read_text(read_medit, write_text(write_medit, fresh), path);
    EXPECT_EQ(again.tets, shape.tets) << path;
    EXPECT_EQ(again.positions, shape.positions) << path;
  }
}

}  // namespace
}  // namespace sinew::io
