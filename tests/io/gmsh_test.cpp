#include "engine/io/gmsh.h"

#include <gtest/gtest.h>

#include "engine/io/medit.h"
#include "engine/io/obj.h"
#include "tests/io/file_checks.h"
#include "tests/shared_data.h"

namespace sinew::io {
namespace {

const char* const everything =
    "$MeshFormat\r\n2.2 0 8\r\n$EndMeshFormat\r\n"
    "any text\n"
    "$PhysicalNames\n1\n3 1 \"my volume\"\n$EndPhysicalNames\n"
    "$Nodes\n5\n10 0.50 0 0\n20 1 0 0\n31 0 1 0\n4000000000 0 0 1.0\n-7 1 1 -1e-2\n$EndNodes\n"
    "$Elements\n5\n1 15 2 0 1 10\n2 1 2 0 1 10 20\n3 2 2 0 1 10 20 31\n4 3 0 10 20 -7 31\n"
    "9 4 3 1 1 0 10 20 31 4000000000\n$EndElements\n"
    "$NodeData\n1\n\"t\"\n1\n0.0\n3\n0\n1\n1\n10 0.5\n$EndNodeData";

std::string with(const std::string& elements) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n$Elements\n" +
         elements;
}

TEST(Gmsh, ReadsPointsOfAnyNumbersFacesAndTets) {
  const Shape shape = read_text(read_gmsh, everything);
  expect_sound(shape, "everything");
  ASSERT_EQ(shape.size(), 5u);
  EXPECT_EQ(shape.positions[4], Vec3(1, 1, -0.01f));
  EXPECT_EQ(shape.faces.points, (std::vector<Index>{0, 1, 2, 0, 1, 4, 2}));
  EXPECT_EQ(shape.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  EXPECT_EQ(shape.notes,
            (std::vector<std::string>{"Kept in the Gmsh file only: 2 elements that are neither faces nor tets.",
                                      "Kept in the Gmsh file only: sections \"PhysicalNames\", \"NodeData\"."}));
}

TEST(Gmsh, ReadsVersionOne) {
  const char* const text =
      "$NOD\n5\n2 0 0 0\n3 1 0 0\n4 0 1 0\n5 0 0 1\n9 1 1 1\n$ENDNOD\n"
      "$ELM\n3\n1 4 1 1 4 2 3 4 5\n2 2 1 1 3 2 3 9\n3 15 1 1 1 2\n$ENDELM\n";
  const Shape shape = read_text(read_gmsh, text);
  EXPECT_EQ(shape.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  EXPECT_EQ(shape.faces.points, (std::vector<Index>{0, 1, 4}));
  EXPECT_EQ(write_text(write_gmsh, shape), text);
}

TEST(Gmsh, OfHigherOrderTheCornersAreRead) {
  const Shape shape =
      read_text(read_gmsh, with("2\n1 11 2 0 1 1 2 3 4 1 1 1 1 1 1\n2 9 2 0 1 1 2 3 4 4 4\n$EndElements\n"));
  EXPECT_EQ(shape.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  EXPECT_EQ(shape.faces.points, (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(shape.notes,
            std::vector<std::string>{"Kept in the Gmsh file only: 2 elements' points between their corners."});
}

TEST(Gmsh, ReplacesOnlyTokensThatChanged) {
  Shape shape = read_text(read_gmsh, everything);
  EXPECT_EQ(write_text(write_gmsh, shape), everything);
  shape.positions[0].x() = 0.75;
  shape.positions[4].z() = 4;
  std::string expected = everything;
  for (const auto& [old, now] : {std::pair<std::string, std::string>{"0.50 ", "0.75 "}, {"-1e-2", "4"}}) {
    ASSERT_NE(expected.find(old), std::string::npos) << old;
    expected.replace(expected.find(old), old.size(), now);
  }
  EXPECT_EQ(write_text(write_gmsh, shape), expected);
}

TEST(Gmsh, RefusesInOneSentence) {
  struct Case {
    std::string text;
    const char* sentence;
  };
  const std::string head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  const Case cases[] = {
      {"", "test: expected $MeshFormat or $NOD, found an empty file"},
      {"ply\n", "test:1:1: expected $MeshFormat or $NOD, found \"ply\""},
      {"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n",
       "test:2:1: expected version 1 or 2 of MSH (\"gmsh -format msh22 -save\" converts others), found \"4.1\""},
      {std::string("$MeshFormat\n2.2 1 8\n\1\0\0\0\n", 27),
       "test:2:5: expected 0, for MSH in text (\"gmsh -format msh22 -save\" converts binary files), found \"1\""},
      {head, "test: expected a section $Nodes, found none"},
      {"$NOD\n0\n$EndNodes\n", "test:3:1: expected $ENDNOD, found \"$EndNodes\""},
      {head + "$Comments\nany\n", "test:6:1: expected \"$EndComments\", found the end of the file"},
      {head + "$Nodes\n4294967290\n1 0 0 0\n$EndNodes\n",
       "test:5:1: expected a count of points that fits into the 19 bytes left, found \"4294967290\""},
      {head + "$Nodes\n1\n1 0 0\n$EndNodes\n", "test:7:1: expected a number of point 1 of 1, found \"$EndNodes\""},
      {head + "$Nodes\n2\n1 0 0 0\n1 0 0 0\n$EndNodes\n",
       "test:7:1: expected another number for point 2 of 2, found \"1\""},
      {head + "$Nodes\n0\n$EndNodes\n$Nodes\n0\n$EndNodes\n",
       "test:7:1: expected one section of points, found \"$Nodes\""},
      {head + "$Elements\n1\n1 4 2 0 1 1 2 3 4\n$EndElements\n",
       "test:6:11: expected the number of a point in element 1 of 1, found \"1\""},
      {with("1\n1 4 2 0 1 1 2 3 5\n$EndElements\n"),
       "test:13:17: expected the number of a point in element 1 of 1, found \"5\""},
      {with("1\n1 4 2 0 1 1 2 3\n$EndElements\n"),
       "test:13:16: expected 4 points in element 1 of 1, found the end of the line"},
      {with("1\n1 4 2 0 1 1 2 3 4 4\n$EndElements\n"), "test:13:19: expected 4 points in element 1 of 1, found \"4\""},
      {with("1\n1 4 2 0 1 1 2 3 1\n$EndElements\n"),
       "test:13:17: expected four different points in element 1 of 1, found \"1\""},
      {with("1\n1 4 999999999999 0 1 1 2 3 1\n$EndElements\n"),
       "test:13:29: expected a whole number of element 1 of 1, found the end of the line"},
      {with("1\n1 4 2 0 1 1 2 3 4\n"), "test:14:1: expected $EndElements, found the end of the file"},
      {with("99\n1 4 2 0 1 1 2 3 4\n"),
       "test:12:1: expected a count of elements that fits into the 19 bytes left, found \"99\""},
  };
  for (const Case& c : cases) EXPECT_EQ(refusal(read_gmsh, c.text), c.sentence) << c.text;
}

TEST(Gmsh, WritesWhatAnotherFormatHeld) {
  Shape shape =
      read_text(read_obj, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 0.5 0.1\nf 1 2 3\nf 1 2 3 4\nf 1 2 3 4 5\n");
  shape.tets = {{0, 1, 2, 4}};
  const std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 -1 0.5 0.1\n$EndNodes\n"
      "$Elements\n6\n1 2 2 0 1 1 2 3\n2 3 2 0 1 1 2 3 4\n3 2 2 0 1 1 2 3\n4 2 2 0 1 1 3 4\n5 2 2 0 1 1 4 5\n"
      "6 4 2 0 1 1 2 3 5\n$EndElements\n";
  EXPECT_EQ(write_text(write_gmsh, shape), text);
  EXPECT_EQ(lost(write_gmsh, shape),
            std::vector<std::string>{"Gmsh cannot hold 1 face of more than 4 corners: cut into triangles."});
  EXPECT_EQ(write_text(write_gmsh, read_text(read_gmsh, text)), text);
}

TEST(Gmsh, RealFilesComeBackExactly) {
  SHARED_DATA(path, "tets/liver.msh");
  expect_exact(read_gmsh, write_gmsh, path.string());
  const Shape liver = read_text(read_gmsh, text_of_file(path.string()));
  EXPECT_EQ(liver.size(), 181u);
  EXPECT_EQ(liver.tets.size(), 596u);
  const Shape again = read_text(read_medit, write_text(write_medit, liver));
  EXPECT_EQ(again.tets, liver.tets);
  EXPECT_EQ(again.positions, liver.positions);
  EXPECT_EQ(read_text(read_gmsh, write_text(write_gmsh, again)).tets, liver.tets);
}

}  // namespace
}  // namespace sinew::io
