#include "engine/io/ply.h"

#include <limits>

#include "tests/io/file_checks.h"
#include "tests/io/ply_maker.h"

namespace sinew::io {

namespace {

const std::vector<double> xs{0, 1, 1.5, -2}, ys{0, 0.25, -3, 7}, zs{4, -0.5, 0, 1};

MadeElement square(const std::string& type) {
  return {"vertex", {scalars(type, "x", xs), scalars(type, "y", ys), scalars(type, "z", zs)}};
}

MadeElement faces(const std::string& type, const std::string& name = "vertex_indices") {
  return {"face", {{type, name, {{0, 1, 2}, {0, 2, 3, 1}}}}};
}

Vec3 point(const Shape& shape, std::size_t i) {
  return shape.positions[i] + shape.origin;
}

std::string header(const std::string& body) {
  return "ply\nformat ascii 1.0\n" + body + "end_header\n";
}

const std::string one_point = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";

/// Encoding, type of coordinates, of face indices, end of lines.
using Layout = std::tuple<std::string, std::string, std::string, std::string>;
class PlyLayouts : public testing::TestWithParam<Layout> {};

}  // namespace

TEST_P(PlyLayouts, ReadPatchAndComeBack) {
  const auto& [encoding, type, index, end] = GetParam();
  MadePly ply{encoding, end, {"comment a  comment ", "obj_info \ttwo"}, {}};
  ply.elements.push_back({"camera", {scalars("double", "f", {0.1}), {"list uint8 short", "pixels", {{1, -2, 3}}}}});
  ply.elements.push_back(faces("list uchar " + index, "vertex_index"));
  ply.elements.push_back(square(type));
  ply.elements.back().properties.insert(ply.elements.back().properties.begin() + 1,
                                        scalars("uchar", "red", {0, 1, 2, 255}));
  ply.elements.back().properties.push_back({"list ushort float", "tags", {{}, {1.5}, {2, 3}, {}}});
  ply.elements.back().properties.push_back(scalars("uchar", "green", {9, 8, 7, 6}));
  ply.elements.back().properties.push_back(scalars("uchar", "blue", {3, 3, 3, 3}));
  ply.elements.push_back({"material", {scalars("int32", "id", {-7, 8})}});
  const std::string text = made(ply);

  Shape shape = read_text(read_ply, text);
  expect_sound(shape, "made");
  ASSERT_EQ(shape.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(shape.positions[i], Vec3(xs[i], ys[i], zs[i])) << i;
  ASSERT_EQ(shape.faces.size(), 2u);
  EXPECT_EQ(shape.faces.points, (std::vector<Index>{0, 1, 2, 0, 2, 3, 1}));
  ASSERT_EQ(shape.attributes.size(), 1u);
  EXPECT_EQ(shape.attributes[0].name, "color");
  EXPECT_EQ(shape.attributes[0].number(3, 0), 255);
  EXPECT_EQ(shape.attributes[0].number(3, 1), 6);
  EXPECT_EQ(write_text(write_ply, shape), text);

  shape.positions[1] = Vec3(10, 20, 30);
  shape.attributes[0].set_number(2, 1, 77);
  ply.elements[2].properties[0].values[1] = {10};
  ply.elements[2].properties[2].values[1] = {20};
  ply.elements[2].properties[3].values[1] = {30};
  ply.elements[2].properties[5].values[2] = {77};
  EXPECT_EQ(write_text(write_ply, shape), made(ply));
}

INSTANTIATE_TEST_SUITE_P(All, PlyLayouts,
                         testing::Combine(testing::Values("ascii", "binary_little_endian", "binary_big_endian"),
                                          testing::Values("float", "float32", "double", "float64"),
                                          testing::Values("char", "uchar", "short", "ushort", "int", "uint", "int8",
                                                          "uint8", "int16", "uint16", "int32", "uint32", "float",
                                                          "double"),
                                          testing::Values("\n", "\r\n", "\r")));

TEST(Ply, PositionsOfWholeNumbersAreRoundedWhenMoved) {
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"})
    for (const char* type : {"char", "short", "int", "int8", "int16", "int32"}) {
      MadeElement vertex{"vertex",
                         {scalars(type, "x", {1, -2}), scalars(type, "y", {3, 4}), scalars(type, "z", {5, 6})}};
      Shape shape = read_text(read_ply, made({encoding, "\n", {}, {vertex}}));
      EXPECT_EQ(shape.positions[1], Vec3(-2, 4, 6)) << type;
      shape.positions[1] += Vec3(0.75, 0, 1e9);
      const Shape again = read_text(read_ply, write_text(write_ply, shape));
      EXPECT_EQ(again.positions[0], Vec3(1, 3, 5));
      EXPECT_EQ(again.positions[1].x(), -1);
      EXPECT_EQ(again.positions[1].y(), 4);
      const double highest = std::string(type).find("32") != std::string::npos || type == std::string("int")
                                 ? 1000000006
                                 : (type[0] == 'c' || type == std::string("int8") ? 127 : 32767);
      EXPECT_EQ(again.positions[1].z(), highest) << type;
    }
}

TEST(Ply, MixedFloatAndDoubleCoordinatesAreDouble) {
  const MadeElement vertex{"vertex",
                           {scalars("float", "x", {0.5}), scalars("double", "y", {0.1}), scalars("float", "z", {2})}};
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const std::string text = made({encoding, "\n", {}, {vertex}});
    Shape shape = read_text(read_ply, text);
    EXPECT_EQ(shape.position_type, Type::Float64);
    EXPECT_EQ(point(shape, 0), Vec3(0.5, 0.1, 2));
    EXPECT_EQ(write_text(write_ply, shape), text);
  }
}

TEST(Ply, AnUnchangedNumberKeepsItsText) {
  const std::string text =
      header("element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float q\n") +
      "1.000 +2 3e0 0.10\n\n -0.0   .5\t5. 1\n7 8 9 nan\n";
  Shape shape = read_text(read_ply, text);
  EXPECT_EQ(write_text(write_ply, shape), text);
  shape.positions[1].y() = 0.1;
  shape.find("q")->set_number(0, 0, 0.2);
  const std::string expected =
      header("element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float q\n") +
      "1.000 +2 3e0 0.2\n\n -0.0   0.1\t5. 1\n7 8 9 nan\n";
  EXPECT_EQ(write_text(write_ply, shape), expected);
}

TEST(Ply, LargeCoordinatesKeepTheirBitsAndMoveByMillimetres) {
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const MadeElement vertex{
        "vertex",
        {scalars("double", "x", {5400000.1, 5400001.0000000009, 5400123.456}),
         scalars("double", "y", {350000.25, 350000.1, 350017.3}), scalars("double", "z", {0.1, 20.2, 1e-30})}};
    const std::string text = made({encoding, "\n", {}, {vertex}});
    Shape shape = read_text(read_ply, text);
    EXPECT_NE(shape.origin.x(), 0);
    EXPECT_EQ(write_text(write_ply, shape), text);
    shape.positions[1].x() += 0.001;
    const Shape again = read_text(read_ply, write_text(write_ply, shape));
    for (const std::size_t i : {0, 2}) EXPECT_EQ(point(again, i), point(shape, i));
    EXPECT_NEAR(point(again, 1).x(), 5400001.001, 1e-8);
    EXPECT_EQ(point(again, 1).y(), 350000.1);
  }
}

TEST(Ply, TextThatIsDeclaredFloatButHoldsMoreStaysDouble) {
  const std::string text = header("element vertex 2\nproperty float x\nproperty float y\nproperty float z\n") +
                           "5400000.001 1 2\n5400000.002 1 3\n";
  Shape shape = read_text(read_ply, text);
  EXPECT_EQ(shape.position_type, Type::Float64);
  ASSERT_EQ(shape.notes.size(), 1u);
  EXPECT_EQ(shape.notes[0], "The coordinates are declared float but have more digits: they are kept as double.");
  EXPECT_EQ(write_text(write_ply, shape), text);
  shape.positions[1].x() += 0.001;
  EXPECT_NEAR(point(read_text(read_ply, write_text(write_ply, shape)), 1).x(), 5400000.003, 1e-8);
}

TEST(Ply, NumbersThatAreNotFiniteAreKept) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const MadeElement vertex{"vertex",
                           {scalars("float", "x", {1, nan, 1e6}), scalars("float", "y", {inf, 2, 1e6}),
                            scalars("float", "z", {-inf, 3, 1e6})}};
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const std::string text = made({encoding, "\n", {}, {vertex}});
    const Shape shape = read_text(read_ply, text);
    EXPECT_TRUE(std::isnan(shape.positions[1].x()));
    EXPECT_EQ(write_text(write_ply, shape), text);
    Shape other = shape;
    other.content = nullptr;
    const Shape again = read_text(read_ply, write_text(write_ply, other));
    EXPECT_TRUE(std::isnan(again.positions[1].x()));
    EXPECT_EQ(point(again, 0).y(), inf);
  }
}

TEST(Ply, FieldsBecomeAttributesOfTheirKind) {
  std::string fields;
  for (const char* field :
       {"float nx",           "float ny",           "float nz",        "uchar red",     "uchar green",
        "uchar blue",         "uchar alpha",        "float intensity", "int patch",     "float vx",
        "float vy",           "float vz",           "float f_dc_0",    "float f_dc_1",  "float f_dc_2",
        "float f_rest_0",     "float f_rest_1",     "float opacity",   "float scale_0", "float scale_1",
        "float scale_2",      "float rot_0",        "float rot_1",     "float rot_2",   "float rot_3",
        "double diffuse_red", "uchar diffuse_green"})
    fields += std::string("property ") + field + "\n";
  const Shape shape = read_text(
      read_ply, header("element vertex 0\nproperty float x\n" + fields + "property float y\nproperty float z\n"));
  std::string found;
  for (const Attribute& a : shape.attributes)
    found += a.name + " " + name_of(a.kind) + " " + name_of(a.type) + " " + std::to_string(a.components) + "\n";
  EXPECT_EQ(found,
            "normal normal float32 3\ncolor color uint8 4\nintensity scalar float32 1\npatch id int32 1\n"
            "velocity velocity float32 3\nf_dc spherical-harmonics float32 3\nf_rest spherical-harmonics float32 2\n"
            "opacity scalar float32 1\nscale log-scale float32 3\nrot quaternion float32 4\n"
            "diffuse_red scalar float64 1\ndiffuse_green scalar uint8 1\n");
}

TEST(Ply, FieldsOfDifferentTypesAreNoGroup) {
  const Shape shape = read_text(
      read_ply, header(one_point + "property float nx\nproperty double ny\nproperty float nz\n") + "0 0 0 1 2 3\n");
  ASSERT_EQ(shape.attributes.size(), 3u);
  EXPECT_EQ(shape.attributes[1].name, "ny");
  EXPECT_EQ(shape.attributes[1].kind, Kind::Scalar);
}

TEST(Ply, AFieldNamedLikeAGroupIsAnotherAttribute) {
  const Shape shape = read_text(
      read_ply, header(one_point + "property float normal\nproperty float nx\nproperty float ny\nproperty float nz\n") +
                    "0 0 0 9 1 2 3\n");
  ASSERT_EQ(shape.attributes.size(), 2u);
  EXPECT_EQ(shape.attributes[0].name, "normal");
  EXPECT_EQ(shape.attributes[1].name, "normal_");
  EXPECT_EQ(shape.attributes[1].number(0, 2), 3);
}

TEST(Ply, StripsBecomeTrianglesThatAllFaceOneWay) {
  const std::string text = header(
                               "element vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement "
                               "tristrips 2\nproperty list int int vertex_indices\n") +
                           "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n9 0 1 2 3 -1 2 3 3 4\n3 4 3 2\n";
  const Shape shape = read_text(read_ply, text);
  EXPECT_EQ(shape.faces.points, (std::vector<Index>{0, 1, 2, 2, 1, 3, 4, 3, 2}));
  EXPECT_EQ(write_text(write_ply, shape), text);
}

TEST(Ply, WhatIsNotUsedIsNoted) {
  const std::string text =
      header(one_point + "property list uchar int tags\nelement face 2\nproperty list uchar int vertex_index\n") +
      "0 0 0 1 5\n2 0 0\n0\nrest\n";
  const Shape shape = read_text(read_ply, text);
  EXPECT_EQ(shape.faces.size(), 0u);
  EXPECT_EQ(shape.notes, (std::vector<std::string>{"5 bytes after the last element are kept but not read.",
                                                   "The list \"tags\" of the points is kept but not used.",
                                                   "2 faces of fewer than 3 corners are kept but not used."}));
  EXPECT_EQ(write_text(write_ply, shape), text);
}

TEST(Ply, ABinaryFileOfLinesThatEndInCarriageReturnMayBeginWithANewline) {
  MadePly ply{"binary_little_endian",
              "\r",
              {},
              {{"vertex", {scalars("uchar", "x", {10}), scalars("uchar", "y", {13}), scalars("uchar", "z", {1})}}}};
  const std::string text = made(ply);
  const Shape shape = read_text(read_ply, text);
  EXPECT_EQ(point(shape, 0), Vec3(10, 13, 1));
  EXPECT_EQ(write_text(write_ply, shape), text);
}

TEST(Ply, ANewFileHoldsPointsAttributesAndFaces) {
  Shape shape =
      read_text(read_ply, made({"ascii", "\n", {"comment lost"}, {square("double"), faces("list uchar int")}}));
  Attribute normal;
  normal.name = "n";
  normal.fields = {"normal_x", "b", "c"};
  normal.kind = Kind::Normal;
  normal.components = 3;
  for (int i = 0; i < 4; ++i) normal.values.resize(normal.values.size() + 12);
  normal.set_number(2, 1, 0.5);
  shape.attributes.push_back(normal);
  Attribute id;
  id.name = "my id";
  id.kind = Kind::Id;
  id.type = Type::Int64;
  id.values.resize(32);
  id.set_number(3, 0, 1e12);
  shape.attributes.push_back(id);
  id.name = "too long";
  id.as<std::int64_t>()[0] = (std::int64_t{1} << 53) + 1;
  shape.attributes.push_back(id);
  EXPECT_EQ(lost(write_ply, shape),
            (std::vector<std::string>{"1 comments are not written.",
                                      "PLY cannot hold the attribute \"too long\": integers beyond 2^53."}));
  const std::string text = write_text(write_ply, shape);
  EXPECT_TRUE(
      text.starts_with("ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
                       "property double z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                       "property double my_id\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"));
  const Shape again = read_text(read_ply, text);
  EXPECT_EQ(again.positions, shape.positions);
  EXPECT_EQ(again.faces.points, shape.faces.points);
  EXPECT_EQ(again.find("normal")->values, normal.values);
  EXPECT_EQ(again.find("my_id")->number(3, 0), 1e12);
}

TEST(Ply, FacesThatChangedAreWritten) {
  Shape shape = read_text(read_ply, made({"ascii", "\n", {}, {square("float"), faces("list uchar int")}}));
  std::swap(shape.faces.points[0], shape.faces.points[1]);
  EXPECT_EQ(read_text(read_ply, write_text(write_ply, shape)).faces.points, shape.faces.points);
}

TEST(Ply, ReadingCanBeCancelled) {
  ReadOptions options;
  options.progress = [](double) { return false; };
  const std::string text = made({"binary_little_endian", "\n", {}, {square("float")}});
  EXPECT_THROW(read_ply("test", bytes_of(text), options), Cancelled);
}

TEST(Ply, WrongHeadersAreRefusedWithTheirPlace) {
  const auto refused = [](const std::string& text) { return refusal(read_ply, text, "a.ply"); };
  EXPECT_EQ(refused(""), "a.ply:1:1: expected \"ply\", found an empty file");
  EXPECT_EQ(refused("PLY\n"), "a.ply:1:1: expected \"ply\", found \"PLY\"");
  EXPECT_EQ(refused("ply x\n"), "a.ply:1:5: expected the end of the line, found \"x\"");
  EXPECT_EQ(refused("ply\n"), "a.ply:2:1: expected \"end_header\", found the end of the file");
  EXPECT_EQ(refused("ply\nformat text 1.0\n"),
            "a.ply:2:8: expected ascii, binary_little_endian or binary_big_endian, found \"text\"");
  EXPECT_EQ(refused("ply\nformat ascii 2.0\n"), "a.ply:2:14: expected version 1.0, found \"2.0\"");
  EXPECT_EQ(refused("ply\nelement vertex 1\n"), "a.ply:2:1: expected \"format\", found \"element\"");
  EXPECT_EQ(refused(header("property float x\n")), "a.ply:3:1: expected an element first, found a property");
  EXPECT_EQ(refused(header("element vertex -1\n")), "a.ply:3:16: expected the number of \"vertex\", found \"-1\"");
  EXPECT_EQ(refused(header("element vertex 99999999999999999999\n")),
            "a.ply:3:16: expected the number of \"vertex\", found \"99999999999999999999\"");
  EXPECT_EQ(refused(header("element vertex\n")),
            "a.ply:3:15: expected the number of \"vertex\", found the end of the line");
  EXPECT_EQ(refused(header("element\n")), "a.ply:3:8: expected the name of an element, found the end of the line");
  EXPECT_EQ(refused(header(one_point + "property flat q\n")),
            "a.ply:7:10: expected a type (char, uchar, short, ushort, int, uint, float, double), found \"flat\"");
  EXPECT_EQ(refused(header(one_point + "property list float int q\n")),
            "a.ply:7:15: expected an integer type for the length of a list, found \"float\"");
  EXPECT_EQ(refused(header(one_point + "property float x\n")),
            "a.ply:7:16: expected each property of \"vertex\" once, found a second \"x\"");
  EXPECT_EQ(refused(header(one_point + "element vertex 3\n")),
            "a.ply:7:9: expected each element once, found a second \"vertex\"");
  EXPECT_EQ(refused(header(one_point + "nonsense\n")),
            "a.ply:7:1: expected element, property, comment, obj_info or end_header, found \"nonsense\"");
  EXPECT_EQ(refused(header("element face 0\nproperty list uchar int vertex_indices\n")),
            "a.ply:5: expected an element \"vertex\" before it, found none");
  EXPECT_EQ(refused(header("element vertex 0\nproperty float x\nproperty float y\nproperty list uchar float z\n")),
            "a.ply:7: expected a property z of the points, found \"x\", \"y\", \"z\"");
  EXPECT_EQ(refused(header("element vertex 0\n")), "a.ply:4: expected a property x of the points, found no property");
}

TEST(Ply, WrongTextIsRefusedWithItsPlace) {
  const auto refused = [](const std::string& rows, const std::string& more = "") {
    return refusal(read_ply, header(one_point + more) + rows, "a.ply");
  };
  EXPECT_EQ(refused(""), "a.ply:8: expected 1 rows of \"vertex\", found only 0 bytes to the end of the file");
  EXPECT_EQ(refused("1 2\n \n"), "a.ply:8:4: expected z of vertex 0, a number, found the end of the line");
  EXPECT_EQ(refused("1 2 abc\n"), "a.ply:8:5: expected z of vertex 0, a number, found \"abc\"");
  EXPECT_EQ(refused("1 2 3 4\n"), "a.ply:8:7: expected the end of the line after z of vertex 0, found \"4\"");
  EXPECT_EQ(refused("1 2 3 256\n", "property uchar q\n"),
            "a.ply:9:7: expected q of vertex 0, a whole number from 0 to 255, found \"256\"");
  EXPECT_EQ(refused("1 2 3 1.5\n", "property int q\n"),
            "a.ply:9:7: expected q of vertex 0, a whole number from -2147483648 to 2147483647, found \"1.5\"");
  EXPECT_EQ(refused("1 2 3 -1\n", "property list char int q\n"),
            "a.ply:9:7: expected the length of q of vertex 0, found -1");
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  EXPECT_EQ(refused("1 2 3\n3 0 0 1\n", face),
            "a.ply:11:7: expected in vertex_indices of face 0 a point below 1, found 1");
  EXPECT_EQ(refused("1 2 3\n3 0 0 -1\n", face),
            "a.ply:11:7: expected in vertex_indices of face 0 a point below 1, found -1");
  EXPECT_EQ(refused("1 2 3\n3 0 0", face),
            "a.ply:11:6: expected vertex_indices of face 0, a whole number from -2147483648 to 2147483647, found the "
            "end of the file");
  EXPECT_EQ(refused("1 2 3\n\n\n\n\n", face),
            "a.ply:15:1: expected vertex_indices of face 0, a whole number from 0 to 255, found the end of the file");
}

TEST(Ply, WrongBinaryDataAreRefusedWithTheirPlace) {
  MadePly ply{
      "binary_little_endian", "\n", {}, {square("float"), {"face", {{"list int int", "vertex_indices", {{0, 1, 2}}}}}}};
  const std::string good = made(ply);
  const std::size_t data = good.find("end_header\n") + 11, face = data + 48;
  const auto at = [](std::size_t byte) { return "a.ply: byte " + std::to_string(byte); };
  const auto refused = [](const std::string& text) { return refusal(read_ply, text, "a.ply"); };
  EXPECT_EQ(refused(good), "read");
  EXPECT_EQ(
      refused(good.substr(0, face - 1)),
      at(data) + ": expected 4 rows of \"vertex\" of at least 12 bytes, found only 47 bytes to the end of the file");
  EXPECT_EQ(refused(good.substr(0, face + 3)),
            at(face) + ": expected 1 rows of \"face\" of at least 4 bytes, found only 3 bytes to the end of the file");
  EXPECT_EQ(refused(good.substr(0, face + 11)),
            at(face + 8) + ": expected vertex_indices of face 0 (4 bytes), found the end of the file after 3");
  ply.elements[1].properties[0].values[0] = {0, 4, 1};
  EXPECT_EQ(refused(made(ply)), at(face + 8) + ": expected in vertex_indices of face 0 a point below 4, found 4");
  ply.elements[1].properties[0] = {"list int float", "vertex_indices", {{0, 1.5, 1}}};
  EXPECT_EQ(refused(made(ply)), at(face + 2 + 8) + ": expected a whole number as vertex_indices of face 0, found 1.5");
  ply.elements[1].properties[0] = scalars("int", "vertex_indices", {-5});
  std::string text = made(ply);
  text.replace(text.find("property int v"), 12, "property list int int");
  EXPECT_EQ(refused(text), at(face) + ": expected the length of vertex_indices of face 0, found -5");
}

TEST(Ply, ABillionRowsOnTheWordOfAHeaderAreNotBelieved) {
  const auto refused = [](const std::string& text) { return refusal(read_ply, text, "a.ply"); };
  const std::string many = "element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n";
  EXPECT_EQ(refused(header(many) + "0 0 0\n"),
            "a.ply:8: expected 4000000000 rows of \"vertex\", found only 6 bytes to the end of the file");
  EXPECT_EQ(refused("ply\nformat binary_little_endian 1.0\n" + many + "end_header\n"),
            "a.ply: byte 124: expected 4000000000 rows of \"vertex\" of at least 12 bytes, found only 0 bytes to "
            "the end of the file");
  EXPECT_EQ(refused(header("element nothing 9000000000000000000\n" + one_point) + "0 0 0\n"), "read");
}

}  // namespace sinew::io
