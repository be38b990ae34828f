#include "engine/io/bgeo.h"

#include <gtest/gtest.h>

#include "tests/io/file_checks.h"

namespace sinew::io {
namespace {

/// Big-endian bytes of a file, piece by piece.
class Maker {
 public:
  Maker& text(std::string_view t) {
    out_ += t;
    return *this;
  }
  Maker& u16(std::uint32_t x) { return text({std::initializer_list<char>{char(x >> 8), char(x)}.begin(), 2}); }
  Maker& u32(std::uint32_t x) { return u16(x >> 16).u16(x & 0xffff); }
  Maker& real(float x) { return u32(std::bit_cast<std::uint32_t>(x)); }
  Maker& reals(std::initializer_list<float> xs) {
    for (const float x : xs) real(x);
    return *this;
  }
  /// Points, primitives, point groups, primitive groups; attributes of points, vertices, primitives, the whole.
  Maker& header(std::initializer_list<std::uint32_t> counts) {
    text("BgeoV").u32(5);
    for (const std::uint32_t x : counts) u32(x);
    return *this;
  }
  Maker& name(std::string_view t) { return u16(static_cast<std::uint32_t>(t.size())).text(t); }
  Maker& define(std::string_view n, std::uint32_t size, std::uint32_t type) {
    name(n).u16(size).u32(type);
    for (std::uint32_t i = 0; i < size; ++i) u32(0);
    return *this;
  }
  operator std::string() const { return out_; }
  std::string str() const { return out_; }

 private:
  std::string out_;
};

/// Two points with one attribute of each type, a triangle and a line, and what else a file can have.
std::string everything() {
  Maker m;
  m.header({3, 4, 1, 0, 6, 1, 1, 1});
  m.define("v", 3, 5).define("N", 3, 5).define("Cd", 3, 0).define("id", 1, 1).define("accel", 3, 5);
  m.name("kind").u16(1).u32(4).u32(2).name("red").name("");
  for (int i = 0; i < 3; ++i) {
    const auto x = static_cast<float>(i);
    m.reals({x, x * x, -0.0F, 1 + x}).reals({1, 2, 3}).reals({0, 0, 1}).reals({0.5F, x, 1}).u32(10 + i);
    m.reals({0, 0, -9.81F}).u32(i == 2 ? 0xffffffff : 1);
  }
  m.define("uv", 2, 0).define("matter", 1, 1);
  m.u32(1).u32(3).text("<");
  for (int c : {0, 1, 2}) m.u16(c).reals({0.25F, 0.75F});
  m.u32(7);
  m.u32(0xffffffff).u16(2).u32(1);  // a run of an open and a closed polygon
  m.u32(2).text(":").u16(0).reals({0, 0}).u16(1).reals({0, 0}).u32(7);
  m.u32(3).text("<");
  for (int c : {2, 1, 0}) m.u16(c).reals({0, 0});
  m.u32(8);
  m.u32(0x8000).u32(1).u16(2).reals({0, 0}).u32(9);
  m.define("detail", 1, 0).real(3).text("group and extra, as they are");
  m.text(std::string("\0\xff", 2));
  return m;
}

TEST(Bgeo, ReadsPointsAttributesAndPolygons) {
  const Shape shape = read_text(read_bgeo, everything());
  expect_sound(shape, "everything");
  ASSERT_EQ(shape.size(), 3u);
  EXPECT_EQ(shape.positions[2], Vec3(2, 4, 0));
  EXPECT_EQ(shape.position_type, Type::Float32);
  std::string all;
  for (const Attribute& a : shape.attributes)
    all += a.name + ":" + name_of(a.kind) + ":" + name_of(a.type) + ":" + std::to_string(a.components) + ":" +
           a.fields.front() + " ";
  EXPECT_EQ(all,
            "velocity:velocity:float32:3:vx normal:normal:float32:3:nx color:color:float32:3:red id:id:int32:1:id "
            "accel:vector:float32:3:accel_0 kind:id:int32:1:kind ");
  EXPECT_EQ(shape.find("velocity")->number(1, 2), 3);
  EXPECT_EQ(shape.find("id")->number(2, 0), 12);
  EXPECT_EQ(shape.find("kind")->number(2, 0), -1);
  EXPECT_EQ(shape.faces.points, (std::vector<Index>{0, 1, 2, 2, 1, 0}));
  EXPECT_EQ(shape.notes,
            (std::vector<std::string>{"Kept in the bgeo file only: 2 texts of the attribute \"kind\".",
                                      "Kept in the bgeo file only: 1 primitive that is not a closed polygon.",
                                      "Kept in the bgeo file only: 1 attribute of vertices.",
                                      "Kept in the bgeo file only: 1 attribute of primitives.",
                                      "Kept in the bgeo file only: 1 attribute of the whole.",
                                      "Kept in the bgeo file only: 1 group."}));
}

TEST(Bgeo, GivesTheSameBytesBack) {
  EXPECT_EQ(write_text(write_bgeo, read_text(read_bgeo, everything())), everything());
}

TEST(Bgeo, ReplacesOnlyValuesThatChanged) {
  const std::string before = everything();
  Shape shape = read_text(read_bgeo, before);
  shape.positions[1].y() = 0.5;
  shape.find("velocity")->set_number(2, 0, -4);
  shape.find("id")->set_number(0, 0, 77);
  const std::string after = write_text(write_bgeo, shape);
  ASSERT_EQ(after.size(), before.size());
  int changed = 0;
  for (std::size_t i = 0; i < after.size(); ++i) changed += after[i] != before[i] ? 1 : 0;
  // 1 = 3f800000 to 0.5 = 3f000000, 1 to -4 = c0800000, 10 to 77.
  EXPECT_EQ(changed, 3);
  const Shape again = read_text(read_bgeo, after);
  EXPECT_EQ(again.positions[1].y(), 0.5);
  EXPECT_EQ(again.find("velocity")->number(2, 0), -4);
  EXPECT_EQ(again.find("id")->number(0, 0), 77);
}

TEST(Bgeo, NoPointsAreAShapeToo) {
  const std::string text = Maker().header({0, 0, 0, 0, 0, 0, 0, 0}).text(std::string("\0\xff", 2));
  EXPECT_EQ(read_text(read_bgeo, text).size(), 0u);
  EXPECT_EQ(write_text(write_bgeo, read_text(read_bgeo, text)), text);
}

TEST(Bgeo, AnUnknownPrimitiveEndsTheFaces) {
  Maker m;
  m.header({3, 3, 0, 0, 0, 0, 0, 0});
  for (int i = 0; i < 3; ++i) m.reals({float(i), 0, 0, 1});
  m.u32(1).u32(3).text("<").u16(0).u16(1).u16(2);
  m.u32(0x20).text("a sphere");
  const Shape shape = read_text(read_bgeo, m.str());
  EXPECT_EQ(shape.faces.size(), 1u);
  EXPECT_EQ(shape.notes,
            std::vector<std::string>{"Kept in the bgeo file only: 2 primitives that are no closed polygons."});
  EXPECT_EQ(write_text(write_bgeo, shape), m.str());
}

TEST(Bgeo, ManyPointsHaveLongIndices) {
  for (const std::size_t n : {65536, 65537}) {
    Shape shape;
    for (std::size_t i = 0; i < n; ++i) shape.positions.emplace_back(static_cast<double>(i), 0, 1);
    const auto last = static_cast<Index>(n - 1);
    shape.faces.add(std::vector<Index>{last, 1, 0, 7});
    const std::string text = write_text(write_bgeo, shape);
    EXPECT_EQ(text.size(), 41 + 16 * n + 9 + 4 * (n == 65536 ? 2 : 4) + 2);
    const Shape again = read_text(read_bgeo, text);
    EXPECT_EQ(again.faces.points, shape.faces.points);
    EXPECT_TRUE(again.notes.empty());
  }
}

TEST(Bgeo, RefusesInOneSentence) {
  const std::string good = everything(), what = "test: byte 0: expected classic bgeo data that begins with \"BgeoV\", ";
  const auto end = [](std::size_t at, const std::string& what_of, std::size_t left) {
    return "test: byte " + std::to_string(at) + ": expected " + what_of + ", found the end of the file after " +
           std::to_string(left);
  };
  struct Case {
    std::string text, sentence;
  };
  const Case cases[] = {
      {"", "test: expected classic bgeo data that begins with \"BgeoV\", found an empty file"},
      {"\x1f\x8b\x08", what + "found gzip-compressed data (unpack the file first, as with gunzip)"},
      {"\x7fNSJb", what + "found the JSON geometry of Houdini 12 and later (save it as classic bgeo)"},
      {"[\"fileversion\"", what + "found the JSON geometry of Houdini 12 and later (save it as classic bgeo)"},
      {"PGEOMETRY V5", what + "found the ascii geometry of .geo files"},
      {"Bgeo5", what + "found \"Bgeo5\""},
      {Maker().text("BgeoV").u32(2), "test: byte 5: expected version 5, found 2"},
      {good.substr(0, 20), end(17, "4 bytes of the count of point groups", 3)},
      {Maker().header({0, 0, 0, 0, 4000000000, 0, 0, 0}),
       "test: byte 41: expected 4000000000 point attributes of at least 12 bytes, found only 0 bytes to the end of the "
       "file"},
      {Maker().header({4000000000, 0, 0, 0, 0, 0, 0, 0}),
       "test: byte 41: expected 4000000000 points of at least 16 bytes, found only 0 bytes to the end of the file"},
      {Maker().header({0, 0, 0, 0, 1, 0, 0, 0}).name("a").u16(0).u32(0).u32(0),
       "test: byte 44: expected at least one value of a point attribute \"a\", found 0"},
      {Maker().header({0, 0, 0, 0, 1, 0, 0, 0}).define("a", 1, 3),
       "test: byte 46: expected a type of 0, 1, 4 or 5 (float, int, index, vector) of a point attribute \"a\", found "
       "3"},
      {Maker().header({0, 0, 0, 0, 1, 0, 0, 0}).name("abcd").u16(65535).u32(0),
       end(53, "262140 bytes of the default of an attribute", 0)},
      {Maker().header({0, 0, 0, 0, 1, 0, 0, 0}).name("a").u16(1).u32(4).u32(9999).u32(0),
       "test: byte 54: expected 9999 texts of at least 2 bytes, found only 4 bytes to the end of the file"},
      {Maker().header({0, 0, 0, 0, 1, 0, 0, 0}).u16(999).text("0123456789"),
       end(43, "999 bytes of the name of an attribute", 10)},
      {Maker().header({1, 1, 0, 0, 0, 0, 0, 0}).reals({0, 0, 0, 1}).u32(1).u32(4000000000).text("<"),
       "test: byte 66: expected 4000000000 points of a primitive of at least 2 bytes, found only 0 bytes to the end of "
       "the file"},
      {Maker().header({1, 1, 0, 0, 0, 0, 0, 0}).reals({0, 0, 0, 1}).u32(1).u32(1).text("?"),
       "test: byte 65: expected \"<\" or \":\" (a closed or an open polygon), found \"?\""},
      {Maker().header({1, 1, 0, 0, 0, 0, 0, 0}).reals({0, 0, 0, 1}).u32(1).u32(1).text("<").u16(1),
       "test: byte 66: expected the number from 0 of one of 1 points, found 1"},
      {Maker().header({1, 1, 0, 0, 0, 0, 0, 0}).reals({0, 0, 0, 1}).u32(0xffffffff).u16(2).u32(1),
       "test: byte 61: expected a run of 1 to 1 primitives, found 2"},
  };
  for (const Case& c : cases) EXPECT_EQ(refusal(read_bgeo, c.text), c.sentence);
}

TEST(Bgeo, AnyCutIsRefusedOrRead) {
  const std::string good = everything();
  for (std::size_t size = 0; size < good.size(); ++size) {
    const std::string sentence = refusal(read_bgeo, good.substr(0, size));
    // What follows the primitives is not looked at.
    EXPECT_TRUE(sentence == "read" || sentence.find(": expected ") != std::string::npos) << size << sentence;
  }
  EXPECT_NE(refusal(read_bgeo, good.substr(0, 300)), "read");
}

TEST(Bgeo, WritesWhatAnotherFormatHeld) {
  Shape shape;
  shape.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0.1f), Vec3(20000.0007, 0, 0)};
  shape.position_type = Type::Float64;
  shape.faces.add(std::vector<Index>{0, 1, 2});
  Attribute color{"color", {"r", "g", "b", "a"}, Kind::Color, Type::UInt8, 4, {}, {}, {}};
  color.values = bytes_of(std::string_view("\x00\x33\xff\xff\x00\x33\xff\x00\x01\x02\x03\x04", 12));
  Attribute normal{"normal", {"nx", "ny", "nz"}, Kind::Normal, Type::Float32, 3, {}, {}, {}};
  normal.values.resize(36);
  Attribute odd{"1 odd", {"odd"}, Kind::Scalar, Type::Float64, 1, {}, {}, {}};
  odd.values.resize(24);
  odd.set_number(1, 0, 0.1);
  Attribute big{"big", {"big"}, Kind::Id, Type::Int64, 1, {}, {}, {}};
  big.values.resize(24);
  big.set_number(1, 0, 5e9);
  Attribute shared{"shared", {"shared"}, Kind::Scalar, Type::Float32, 1, {}, {0, 2}, {0, 1}};
  shared.values.resize(4);
  shape.attributes = {color, normal, odd, big, shared};
  EXPECT_EQ(
      lost(write_bgeo, shape),
      (std::vector<std::string>{"bgeo rounds the doubles of the attribute \"1 odd\" to floats.",
                                "bgeo cannot hold the attribute \"big\": integers beyond 32 bits.",
                                "bgeo cannot hold the attribute \"shared\": its values do not belong to one point "
                                "each.",
                                "The file's type of coordinates rounds moved points by up to 7e-04."}));
  const Shape again = read_text(read_bgeo, write_text(write_bgeo, shape));
  EXPECT_EQ(again.faces.points, shape.faces.points);
  ASSERT_TRUE(again.find("color") && again.find("Alpha") && again.find("normal") && again.find("_1_odd"));
  EXPECT_FLOAT_EQ(static_cast<float>(again.find("color")->number(0, 1)), 0.2F);
  EXPECT_EQ(again.find("Alpha")->number(0, 0), 1);
  EXPECT_EQ(again.attributes.size(), 4u);
}

TEST(Bgeo, SaysWhatIsLostWithTheLayout) {
  Shape shape = read_text(read_bgeo, everything());
  shape.positions.pop_back();
  shape.faces = {};
  for (Attribute& a : shape.attributes) a.values.resize(2 * a.row_size());
  const std::vector<std::string> sentences = lost(write_bgeo, shape);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_EQ(sentences[0],
            "What the bgeo file held besides points, attributes and polygons is not written: the points, attributes or "
            "faces are no longer those of the file.");
  EXPECT_EQ(read_text(read_bgeo, write_text(write_bgeo, shape)).size(), 2u);
}

}  // namespace
}  // namespace sinew::io
