#include "engine/io/stl.h"

#include "tests/io/file_checks.h"
#include "tests/shared_data.h"

namespace sinew::io {

namespace {

template <class T>
void put(std::string& out, T x) {
  out.append(reinterpret_cast<const char*>(&x), sizeof(x));
}

/// A binary file of facets whose nine coordinates are `values`, the normal (0, 0, 1) and attribute bytes 7.
std::string binary(std::string header, const std::vector<std::vector<float>>& facets) {
  header.resize(80, '\0');
  put(header, static_cast<std::uint32_t>(facets.size()));
  for (const auto& facet : facets) {
    for (const float x : {0.0F, 0.0F, 1.0F}) put(header, x);
    for (const float x : facet) put(header, x);
    put(header, std::uint16_t{7});
  }
  return header;
}

const std::vector<std::vector<float>> two{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 0, 0, 1, 1, 0, 0, 1, 0.5F}};

const std::string ascii =
    "solid a name\r\n facet normal 0 0 1.0\n  outer loop\n   vertex 0 0 0\n   vertex 1.50 0 0\n   vertex 0 1e0 0\n"
    "  endloop\n endfacet\nendsolid a name\nSOLID\nFACET NORMAL 0 0 -1 OUTER LOOP VERTEX 1 2 3 VERTEX 4 5 6 VERTEX 7 8 "
    "9 "
    "ENDLOOP ENDFACET ENDSOLID\n";

}  // namespace

TEST(Stl, EachFacetHasPointsAndANormalOfItsOwn) {
  const Shape shape = read_text(read_stl, binary("title", two));
  expect_sound(shape, "binary");
  ASSERT_EQ(shape.size(), 6u);
  EXPECT_EQ(shape.faces.points, (std::vector<Index>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(shape.positions[5] + shape.origin, Vec3(0, 1, 0.5));
  EXPECT_STREQ(representation(shape), "polygon soup");
  const Attribute& normal = *shape.find("normal");
  EXPECT_EQ(normal.kind, Kind::Normal);
  EXPECT_EQ(normal.count(), 2u);
  EXPECT_EQ(normal.number(1, 2), 1);
  EXPECT_EQ(normal.points[normal.point_offsets[1]], 3u);
  EXPECT_EQ(shape.notes, (std::vector<std::string>{"The attribute bytes of 2 facets are kept but not used."}));
}

TEST(Stl, ABinaryFileIsPatched) {
  const std::string text = binary("title\x01 and more", two);
  Shape shape = read_text(read_stl, text);
  EXPECT_TRUE(write_text(write_stl, shape) == text);
  shape.positions[4].y() += 2;
  shape.find("normal")->set_number(0, 1, -1);
  std::string expected = text;
  const float y = 3, n = -1;
  std::memcpy(&expected[84 + 50 + 12 + 16], &y, 4);
  std::memcpy(&expected[84 + 4], &n, 4);
  EXPECT_TRUE(write_text(write_stl, shape) == expected);
}

TEST(Stl, ABinaryHeaderMayBeginWithSolid) {
  for (const char* title : {"solid", "solid facet normal 0 0 1 outer loop vertex", "  solid\n"}) {
    std::string header = title;
    header.resize(80, ' ');
    const std::string text = binary(header, two);
    EXPECT_EQ(read_text(read_stl, text).size(), 6u) << title;
  }
}

TEST(Stl, AnAsciiFileIsPatched) {
  Shape shape = read_text(read_stl, ascii);
  expect_sound(shape, "ascii");
  ASSERT_EQ(shape.size(), 6u);
  EXPECT_EQ(shape.position_type, Type::Float32);
  EXPECT_EQ(shape.notes, (std::vector<std::string>{"The names of 2 solids are kept."}));
  EXPECT_EQ(write_text(write_stl, shape), ascii);
  shape.positions[1].z() += 0.1;
  shape.find("normal")->set_number(1, 0, 0.5);
  std::string expected = ascii;
  expected.replace(expected.find("1.50 0 0"), 8, "1.50 0 0.1");
  expected.replace(expected.find("0 0 -1"), 6, "0.5 0 -1");
  EXPECT_EQ(write_text(write_stl, shape), expected);
}

TEST(Stl, LargeCoordinatesInTextMoveByMillimetres) {
  std::string text = ascii;
  text.replace(text.find("1.50 0 0"), 8, "5400000.001 0 0");
  Shape shape = read_text(read_stl, text);
  EXPECT_EQ(shape.position_type, Type::Float64);
  EXPECT_EQ(write_text(write_stl, shape), text);
  shape.positions[1].x() += 0.001;
  EXPECT_NEAR(read_text(read_stl, write_text(write_stl, shape)).positions[1].x() + shape.origin.x(), 5400000.002, 1e-8);
}

TEST(Stl, ANewFileHoldsTrianglesAndTheirNormals) {
  Shape shape;
  shape.position_type = Type::Float64;
  shape.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0.1}, {9, 9, 9}};
  shape.faces.add(std::array<Index, 4>{0, 1, 2, 3});
  shape.faces.add(std::array<Index, 3>{0, 4, 1});
  shape.faces.add(std::array<Index, 3>{0, 0, 1});
  Attribute quality;
  quality.name = "quality";
  quality.values.resize(24);
  shape.attributes.push_back(quality);
  EXPECT_EQ(lost(write_stl, shape),
            (std::vector<std::string>{"STL cannot hold 1 face of more than 3 corners: cut into triangles.",
                                      "STL cannot hold points that faces share: each triangle has its own.",
                                      "STL cannot hold 1 point of no face.",
                                      "STL cannot hold coordinates beyond float: they change by up to 1.4901161e-09.",
                                      "STL cannot hold the attribute \"quality\"."}));
  const Shape again = read_text(read_stl, write_text(write_stl, shape));
  ASSERT_EQ(again.faces.size(), 4u);
  const Attribute& normal = *again.find("normal");
  EXPECT_EQ(normal.number(0, 2), 1);
  EXPECT_EQ(normal.number(2, 1), 1);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(normal.number(3, c), 0);
  EXPECT_EQ(again.positions[5] + again.origin, Vec3(0, 1, 0));
}

TEST(Stl, PointsWithoutFacesAreRefused) {
  Shape shape;
  shape.positions.resize(3);
  WriteReport report;
  try {
    write_stl("a.stl", shape, report);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "a.stl: expected a shape with faces for STL, found 3 points without any");
  }
}

TEST(Stl, WrongFilesAreRefusedWithTheirPlace) {
  const auto refused = [](const std::string& text) { return refusal(read_stl, text, "a.stl"); };
  EXPECT_EQ(refused(""), "a.stl: expected an STL file (\"solid\" or a header of 84 bytes), found an empty file");
  EXPECT_EQ(refused("hello"), "a.stl: expected an STL file (\"solid\" or a header of 84 bytes), found \"hello\"");
  const std::string good = binary("title", two);
  EXPECT_EQ(refused(good.substr(0, good.size() - 1)),
            "a.stl: byte 84: expected 2 facets of at least 50 bytes, found only 99 bytes to the end of the file");
  EXPECT_EQ(refused(binary("solid", two).substr(0, 100)),
            "a.stl: byte 84: expected 2 facets of at least 50 bytes, found only 16 bytes to the end of the file");
  EXPECT_EQ(refused("solid"), "a.stl:1:6: expected facet or endsolid, found the end of the file");
  EXPECT_EQ(refused("solid\nfacet normal 0 0 x"), "a.stl:2:19: expected outer, found the end of the file");
  EXPECT_EQ(
      refused("solid\nfacet normal 0 0 x\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\nendloop\nendfacet"),
      "a.stl:2:18: expected a number, found \"x\"");
  EXPECT_EQ(refused("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nendloop\nendfacet"),
            "a.stl:6:1: expected vertex, found \"endloop\"");
  EXPECT_EQ(refused("solid\nendsolid\nfacet"), "a.stl:3:1: expected solid, found \"facet\"");
  EXPECT_EQ(refused("solid\nendsolid"), "read");
}

TEST(Stl, BytesBehindTheLastFacetAreKept) {
  const std::string text = binary("title", two) + "tail";
  const Shape shape = read_text(read_stl, text);
  EXPECT_EQ(shape.notes.back(), "4 bytes after the last facet are kept but not read.");
  EXPECT_TRUE(write_text(write_stl, shape) == text);
}

class EmptyStl : public testing::TestWithParam<const char*> {};

TEST_P(EmptyStl, IsAShapeWithoutPoints) {
  SHARED_DATA(path, GetParam());
  const auto shape = read(path.string());
  EXPECT_EQ(shape->size(), 0u);
  EXPECT_EQ(write_text(write_stl, *shape), text_of_file(path.string()));
}

INSTANTIATE_TEST_SUITE_P(Shared, EmptyStl,
                         testing::Values("malformed/trimesh/empty.stl", "malformed/trimesh/stl_empty_bin.stl"));

class RealStl : public testing::TestWithParam<const char*> {};

TEST_P(RealStl, ComesBackByteForByte) {
  SHARED_DATA(path, GetParam());
  expect_exact(read_stl, write_stl, path.string());
}

INSTANTIATE_TEST_SUITE_P(Shared, RealStl,
                         testing::Values("soups/Spider_binary.stl", "soups/busted.STL", "soups/multibody.stl",
                                         "soups/soup.stl"));

}  // namespace sinew::io
