#include "engine/io/vtk.h"

#include <gtest/gtest.h>

#include "tests/io/file_checks.h"

namespace sinew::io {
namespace {

const char* const everything =
    "# vtk DataFile Version 4.2\r\n"
    "any title 1 2 3\r\n"
    "ASCII\r\n"
    "DATASET POLYDATA\r\n"
    "FIELD FieldData 1\r\ntime 1 1 double\r\n0.5\r\n"
    "METADATA\r\nINFORMATION 0\r\n\r\n"
    "points 4 float\r\n"
    "0.50 0 0  1 0 0 1.0\r\n"
    "1 0\r\n0 1 -1e-2\r\n"
    "VERTICES 1 2\n1 0\n"
    "LINES 1 3\n2 0 1\n"
    "POLYGONS 2 7\n3 0 1 2\n2 0 1\n"
    "CELL_DATA 4\nSCALARS part int 1\nLOOKUP_TABLE default\n1 2 3 4\n"
    "POINT_DATA 4\n"
    "SCALARS Id unsigned_int\nLOOKUP_TABLE default\n7 8 9 4294967295\n"
    "VECTORS force double\n1 0 0  0 1 0  0 0 1  0.1 nan -inf\n"
    "NORMALS n float\n0 0 1 0 0 1 0 0 1 0 0 1\n"
    "COLOR_SCALARS cd 3\n1 0 0 0 1 0 0 0 1 0.5 0.5 0.5\n"
    "LOOKUP_TABLE table 1\n0 0 0 1\n"
    "FIELD FieldData 4\n"
    "velocity 3 4 float\n1 2 3 4 5 6 7 8 9 10 11 12\n"
    "names 1 4 string\na b\nc\n\nd\n"
    "my%20speed 1 4 char\n-1 2 3 4\n"
    "odd 2 1 int\n5 6";

TEST(Vtk, ReadsAllSortsOfSections) {
  const Shape shape = read_text(read_vtk, everything);
  expect_sound(shape, "everything");
  ASSERT_EQ(shape.size(), 4u);
  EXPECT_EQ(shape.positions[3], Vec3(0, 1, -0.01f));
  EXPECT_EQ(shape.faces.points, (std::vector<Index>{0, 1, 2}));
  std::string all;
  for (const Attribute& a : shape.attributes)
    all += a.name + ":" + name_of(a.kind) + ":" + name_of(a.type) + ":" + std::to_string(a.components) + " ";
  EXPECT_EQ(all,
            "Id:id:uint32:1 force:vector:float64:3 normal:normal:float32:3 color:color:float32:3 "
            "velocity:velocity:float32:3 my speed:scalar:int8:1 ");
  EXPECT_EQ(shape.find("Id")->number(3, 0), 4294967295.0);
  EXPECT_EQ(shape.find("velocity")->number(3, 0), 10);
  EXPECT_EQ(shape.notes,
            (std::vector<std::string>{"Kept in the VTK file only: 2 cells that are neither polygons nor tets.",
                                      "Kept in the VTK file only: 4 arrays that are not of the points' numbers."}));
}

TEST(Vtk, GivesTheSameBytesBack) {
  EXPECT_EQ(write_text(write_vtk, read_text(read_vtk, everything)), everything);
}

TEST(Vtk, ReplacesOnlyTokensThatChanged) {
  Shape shape = read_text(read_vtk, everything);
  shape.positions[0].x() = 0.75;
  shape.positions[3].z() = 4;
  shape.find("velocity")->set_number(3, 2, -1);
  shape.find("force")->set_number(3, 1, 0.3);
  std::string expected = everything;
  for (const auto& [old, now] : {std::pair<std::string, std::string>{"0.50 ", "0.75 "},
                                 {"-1e-2", "4"},
                                 {" 11 12\n", " 11 -1\n"},
                                 {"0.1 nan", "0.1 0.3"}}) {
    ASSERT_NE(expected.find(old), std::string::npos) << old;
    expected.replace(expected.find(old), old.size(), now);
  }
  EXPECT_EQ(write_text(write_vtk, shape), expected);
}

TEST(Vtk, CellsOfVersion5HaveOffsets) {
  const std::string text =
      "# vtk DataFile Version 5.1\nt\nASCII\nDATASET POLYDATA\nPOINTS 4 double\n0 0 0 1 0 0 1 1 0 0 1 0\n"
      "POLYGONS 3 7\nOFFSETS vtktypeint64\n0 3 7\nCONNECTIVITY vtktypeint64\n0 1 2 0 1 2 3\n"
      "METADATA\nINFORMATION 1\nNAME a LOCATION b\nDATA 1\n\nPOINT_DATA 4\n";
  const Shape shape = read_text(read_vtk, text);
  expect_sound(shape, "5");
  EXPECT_EQ(shape.position_type, Type::Float64);
  EXPECT_EQ(shape.faces.points, (std::vector<Index>{0, 1, 2, 0, 1, 2, 3}));
  EXPECT_EQ(write_text(write_vtk, shape), text);
}

/// A binary file of two points, with texts and bits that nothing must mistake for points.
std::string binary() {
  const auto floats = [](std::initializer_list<float> xs) {
    std::string out;
    for (const float x : xs) {
      const auto bits = std::bit_cast<std::uint32_t>(x);
      for (const int shift : {24, 16, 8, 0}) out += static_cast<char>(bits >> shift);
    }
    return out;
  };
  return "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 2 float\n" +
         floats({1, 2, 3, 4, 5, 6}) + "\nCELLS 2 4\n" + std::string("\0\0\0\1\0\0\0\0\0\0\0\1\0\0\0\1", 16) +
         "\nCELL_TYPES 2\n" + std::string("\0\0\0\1\0\0\0\1", 8) + "\nPOINT_DATA 2\nFIELD f 3\nnames 1 2 string\n" +
         std::string(
             "\xc3"
             "abc"
             "\x80\x02"
             "xy",
             8) +
         "\nbits 1 2 bit\n\x40\nv 3 2 float\n" + floats({0.5F, 0, 0, 0, 0.25F, 0}) + "\n";
}

TEST(Vtk, ReadsBinaryBigEndian) {
  const Shape shape = read_text(read_vtk, binary());
  expect_sound(shape, "binary");
  ASSERT_EQ(shape.size(), 2u);
  EXPECT_EQ(shape.positions[1], Vec3(4, 5, 6));
  ASSERT_TRUE(shape.find("velocity"));
  EXPECT_EQ(shape.find("velocity")->number(1, 1), 0.25);
  EXPECT_EQ(shape.notes,
            std::vector<std::string>{"Kept in the VTK file only: 2 arrays that are not of the points' numbers."});
  EXPECT_EQ(write_text(write_vtk, shape), binary());
  Shape moved = shape;
  moved.positions[1].x() = 9;
  const std::string text = write_text(write_vtk, moved);
  EXPECT_EQ(text.size(), binary().size());
  EXPECT_EQ(read_text(read_vtk, text).positions[1], Vec3(9, 5, 6));
}

TEST(Vtk, AnyCutOfABinaryFileIsRefusedOrExact) {
  const std::string good = binary();
  for (std::size_t size = 0; size < good.size(); ++size) {
    const std::string cut = good.substr(0, size), sentence = refusal(read_vtk, cut);
    if (sentence == "read") {
      EXPECT_EQ(write_text(write_vtk, read_text(read_vtk, cut)), cut);
    } else {
      EXPECT_NE(sentence.find(": expected "), std::string::npos) << sentence;
    }
  }
}

TEST(Vtk, RefusesInOneSentence) {
  const std::string head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n";
  const std::string point = head + "POINTS 1 float\n1 2 3\n";
  struct Case {
    std::string text, sentence;
  };
  const Case cases[] = {
      {"", "test: expected a first line that begins with \"# vtk DataFile Version\", found an empty file"},
      {"vtk", "test:1: expected a first line that begins with \"# vtk DataFile Version\", found \"vtk\""},
      {"# vtk DataFile Version 3.0\nt\nTEXT", "test:3:1: expected ASCII or BINARY, found \"TEXT\""},
      {"# vtk DataFile Version 3.0\nt\nASCII\nPOINTS", "test:4:1: expected DATASET, found \"POINTS\""},
      {"# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\n",
       "test:4:9: expected a DATASET of POLYDATA or UNSTRUCTURED_GRID, found \"STRUCTURED_POINTS\""},
      {head, "test:5:1: expected a section POINTS, found the end of the file"},
      {head + "POINT 1 float", "test:5:1: expected a keyword such as POINTS, POLYGONS or POINT_DATA, found \"POINT\""},
      {head + "POINTS -1 float", "test:5:8: expected the count of points, found \"-1\""},
      {head + "POINTS 1 real", "test:5:10: expected a type of points such as float, found \"real\""},
      {head + "POINTS 1000000000 float\n1 2 3\n",
       "test: byte 75: expected 1000000000 rows of points of 3 values, found only 7 bytes"},
      {head + "POINTS 1 float\n1 2 x\n", "test:6:5: expected value 3 of 3 of points, of type float32, found \"x\""},
      {head + "POINTS 1 float\n1     2",
       "test:6:8: expected value 3 of 3 of points, of type float32, found the end of the data"},
      {point + "POINTS 1 float\n1 2 3\n", "test:7:1: expected one section POINTS, found \"POINTS\""},
      {point + "POLYGONS 1 4\n3 0 0 1\n",
       "test:7:10: expected polygons of the 1 points, not of point 1, behind, found \"1\""},
      {point + "POLYGONS 1 4\n4 0 0 0\n",
       "test:7:10: expected cells of 4 numbers that are as many as they say, found \"1\""},
      {point + "POLYGONS 1 5\n3 0 0 0 0\n", "test:7:10: expected 4 numbers of cells, not 5, behind, found \"1\""},
      {point + "POLYGONS 2 3\nOFFSETS int\n0 4\nCONNECTIVITY int\n0 0 0\n",
       "test:8:1: expected offsets from 0 to 3 behind, found \"OFFSETS\""},
      {point + "POINT_DATA 2\n", "test:7:12: expected data of the 1 points, found \"2\""},
      {point + "POINT_DATA 1\nSCALARS a int 0\n", "test:8:15: expected a count of values of 1 to 65536, found \"0\""},
      {point + "POINT_DATA 1\nSCALARS a int\nLOOKUP_TABLE d\n1.5\n",
       "test:10:1: expected value 1 of 1 of the array \"a\", of type int32, found \"1.5\""},
      {point + "POINT_DATA 1\nSCALARS a unsigned_char\nLOOKUP_TABLE d\n256\n",
       "test:10:1: expected value 1 of 1 of the array \"a\", of type uint8, found \"256\""},
      {point + "POINT_DATA 1\nODD a int\n",
       "test:8:1: expected a keyword of data such as SCALARS, VECTORS or FIELD, found \"ODD\""},
      {point + "POINT_DATA 1\nFIELD f 2\na 1 1 int\n5\n",
       "test:11:1: expected array 2 of 2, found the end of the file"},
      {point + "POINT_DATA 1\nFIELD f 1\na 1 4000000000 string\nb\n",
       "test:10:1: expected an array of 4000000000 rows that fits into the file, found \"b\""},
      {head + std::string(1, '\0'), "test: byte 52: expected text in ASCII or UTF-8, found a zero byte"},
  };
  for (const Case& c : cases) EXPECT_EQ(refusal(read_vtk, c.text), c.sentence) << c.text;
}

TEST(Vtk, WritesWhatAnotherFormatHeld) {
  Shape shape;
  shape.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0.1f), Vec3(0, 1, 0)};
  Attribute packed{"color", {"rgb"}, Kind::Color, Type::UInt32, 1, {}, {}, {}};
  packed.values.resize(12);
  packed.set_number(1, 0, 0x0133ff);
  Attribute odd{"an odd%one", {"odd"}, Kind::Scalar, Type::Float64, 1, {}, {}, {}};
  odd.values.resize(24);
  odd.set_number(1, 0, 0.1);
  Attribute shared{"shared", {"shared"}, Kind::Scalar, Type::Float32, 1, {}, {0, 2}, {0, 1}};
  shared.values.resize(4);
  Attribute keyword = odd;
  keyword.name = "metadata";
  shape.attributes = {packed, odd, keyword, shared};
  EXPECT_EQ(lost(write_vtk, shape),
            std::vector<std::string>{
                "VTK cannot hold the attribute \"shared\": its values do not belong to one point each."});
  const Shape again = read_text(read_vtk, write_text(write_vtk, shape));
  EXPECT_EQ(again.positions, shape.positions);
  ASSERT_TRUE(again.find("color") && again.find("an odd%one") && again.find("metadata"));
  EXPECT_EQ(again.find("color")->type, Type::UInt8);
  EXPECT_EQ(again.find("color")->number(1, 1), 0x33);
  EXPECT_EQ(again.find("an odd%one")->number(1, 0), 0.1);
  EXPECT_TRUE(again.notes.empty());
  shape.faces.add(std::vector<Index>{0, 1, 2});
  EXPECT_EQ(read_text(read_vtk, write_text(write_vtk, shape)).faces.points, shape.faces.points);
}

TEST(Vtk, SaysWhatIsLostWithTheLayout) {
  Shape shape = read_text(read_vtk, everything);
  shape.faces = {};
  EXPECT_EQ(lost(write_vtk, shape).size(), 1u);
  EXPECT_EQ(read_text(read_vtk, write_text(write_vtk, shape)).size(), 4u);
}

const char* const grid =
    "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n"
    "0.50 0 0 1 0 0 0 1 0 0 0 1.0 1 1 1\n"
    "CELLS 6 25\n4 0 1 2 3\n3 0 1 2\n4 0 1 4 2\n1 0\n2 0 1\n5 0 1 2 3 4\n"
    "CELL_TYPES 6\n10 5 9 1 3 14\n"
    "POINT_DATA 5\nSCALARS s float\nLOOKUP_TABLE default\n1 2 3 4 5\n";

TEST(Vtk, ReadsTheTetsAndFacesOfAGrid) {
  Shape shape = read_text(read_vtk, grid);
  expect_sound(shape, "grid");
  EXPECT_EQ(shape.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  EXPECT_EQ(shape.faces.points, (std::vector<Index>{0, 1, 2, 0, 1, 4, 2}));
  EXPECT_EQ(shape.notes,
            std::vector<std::string>{"Kept in the VTK file only: 2 cells that are neither polygons nor tets."});
  EXPECT_EQ(write_text(write_vtk, shape), grid);
  shape.positions[0].x() = 0.75;
  std::string expected = grid;
  expected.replace(expected.find("0.50"), 4, "0.75");
  EXPECT_EQ(write_text(write_vtk, shape), expected);
}

TEST(Vtk, WritesTetsAsAGrid) {
  for (const bool faces : {true, false}) {
    Shape shape = read_text(read_vtk, grid);
    shape.content = nullptr;
    if (!faces) shape.faces = {};
    const std::string text = write_text(write_vtk, shape);
    EXPECT_NE(text.find("UNSTRUCTURED_GRID"), std::string::npos);
    const Shape again = read_text(read_vtk, text);
    EXPECT_EQ(again.tets, shape.tets);
    EXPECT_EQ(again.faces.points, shape.faces.points);
    EXPECT_EQ(again.faces.offsets, shape.faces.offsets);
    EXPECT_EQ(again.positions, shape.positions);
    EXPECT_EQ(again.find("s")->values, shape.find("s")->values);
    EXPECT_TRUE(again.notes.empty());
    EXPECT_EQ(write_text(write_vtk, again), text);
  }
}

TEST(Vtk, RefusesTetsThatAreNone) {
  const auto text = [](const std::string& cells) {
    return "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
           "0 0 0 1 0 0 0 1 0 0 0 1\n" +
           cells;
  };
  EXPECT_EQ(refusal(read_vtk, text("CELLS 1 5\n4 0 1 2 4\nCELL_TYPES 1\n10\n")),
            "test:9:12: expected cells of the 4 points, not of point 4, behind, found \"1\"");
  EXPECT_EQ(refusal(read_vtk, text("CELLS 1 5\n4 0 1 2 1\nCELL_TYPES 1\n10\n")),
            "test:9:12: expected tets of four different points, not of point 1 twice as cell 0, in front, found \"1\"");
  EXPECT_EQ(
      refusal(read_vtk, text("CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n10\n")),
      "test:9:12: expected tets of four different points, not of one of 3 points as cell 0, in front, found \"1\"");
  EXPECT_EQ(refusal(read_vtk, text("CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 2\n10 10\n")),
            "test:9:12: expected types of the 1 cells in front of them, found \"2\"");
  EXPECT_EQ(refusal(read_vtk, text("CELLS 1 5\n4 0 1 2 3\nCELLS 1 5\n4 0 1 2 3\n")),
            "test:9:1: expected one section CELLS, found \"CELLS\"");
}

}  // namespace
}  // namespace sinew::io
