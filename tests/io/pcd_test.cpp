#include "engine/io/pcd.h"

#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <limits>

#include "tests/io/file_checks.h"
#include "tests/shared_data.h"

namespace sinew::io {
namespace {

std::string raw(const auto&... values) {
  std::string out;
  (out.append(reinterpret_cast<const char*>(&values), sizeof(values)), ...);
  return out;
}

std::string header(const std::string& fields, const std::string& sizes, const std::string& types,
                   const std::string& counts, int width, int height, const std::string& data) {
  return "# made\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nCOUNT " + counts +
         "\nWIDTH " + std::to_string(width) + "\nHEIGHT " + std::to_string(height) +
         "\n# a comment\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS " + std::to_string(width * height) + "\nDATA " + data + "\n";
}

const char* const ascii =
    "# .PCD v.7\r\nVERSION .7\nFIELDS x y z _ rgb label far\nSIZE 4 4 4 1 4 2 8\nTYPE F F F U F I U\nCOUNT 1 1 1 2 1 1 "
    "1\n"
    "WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n"
    "  1.50 2e0 -3  128 63  4.2108e+06 -7\t18446744073709551615\r\n"
    "nan 0.1 -0 0 255 nan +8 9007199254740993";

/// Two by three points, one of them NaN; a colour whose bits are a NaN with a payload; a field of three values.
std::string binary_points() {
  std::string out;
  for (int i = 0; i < 6; ++i) {
    const float x = i == 4 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(i) * 0.1F;
    out += raw(x, 2.0F * static_cast<float>(i), -1.0F, std::uint32_t{0xff8000ffU} - static_cast<unsigned>(i),
               std::uint32_t{0xdeadbeef}, 0.0F, 0.6F, 0.8F, 1.0, 2.0, 3.0 + i);
  }
  return out;
}

std::string binary() {
  return header("x y z rgb _ normal_x normal_y normal_z hist", "4 4 4 4 4 4 4 4 8", "F F F F U F F F F",
                "1 1 1 1 1 1 1 1 3", 2, 3, "binary") +
         binary_points();
}

/// The same points in compressed form, as literal runs.
std::string compressed() {
  const std::string rows = binary_points();
  const std::size_t sizes[] = {4, 4, 4, 4, 4, 4, 4, 4, 24};
  std::string columns, packed;
  for (std::size_t f = 0, offset = 0; f < 9; offset += sizes[f++])
    for (std::size_t i = 0; i < 6; ++i) columns += rows.substr(i * 56 + offset, sizes[f]);
  for (std::size_t i = 0; i < columns.size(); i += 32) {
    const std::string run = columns.substr(i, 32);
    packed += static_cast<char>(run.size() - 1) + run;
  }
  return header("x y z rgb _ normal_x normal_y normal_z hist", "4 4 4 4 4 4 4 4 8", "F F F F U F F F F",
                "1 1 1 1 1 1 1 1 3", 2, 3, "binary_compressed") +
         raw(static_cast<std::uint32_t>(packed.size()), static_cast<std::uint32_t>(columns.size())) + packed + "tail";
}

void expect_values(const Shape& shape) {
  expect_sound(shape, "made");
  ASSERT_EQ(shape.size(), 6u);
  EXPECT_EQ(shape.position_type, Type::Float32);
  EXPECT_EQ(shape.positions[3].x() + shape.origin.x(), 3 * 0.1F);
  EXPECT_TRUE(std::isnan(shape.positions[4].x()));
  ASSERT_EQ(shape.attributes.size(), 3u);
  const Attribute *normal = shape.find("normal"), *color = shape.find("color"), *hist = shape.find("hist");
  ASSERT_TRUE(normal && color && hist);
  EXPECT_EQ(normal->kind, Kind::Normal);
  EXPECT_EQ(normal->as<float>()[5], 0.8F);
  EXPECT_EQ(color->kind, Kind::Color);
  EXPECT_EQ(color->type, Type::Float32);
  EXPECT_EQ(color->fields, std::vector<std::string>{"rgb"});
  std::uint32_t bits = 0;
  std::memcpy(&bits, color->values.data() + 8, 4);
  EXPECT_EQ(bits, 0xff8000fdU);
  EXPECT_EQ(hist->components, 3);
  EXPECT_EQ(hist->fields[2], "hist[2]");
  EXPECT_EQ(hist->number(5, 2), 8);
}

TEST(Pcd, ReadsAscii) {
  const Shape shape = read_text(read_pcd, ascii);
  expect_sound(shape, "ascii");
  ASSERT_EQ(shape.size(), 2u);
  EXPECT_EQ(shape.find("label")->kind, Kind::Id);
  EXPECT_EQ(shape.find("label")->as<std::int16_t>()[1], 8);
  EXPECT_EQ(shape.find("far")->as<std::uint64_t>()[0], std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(shape.find("far")->as<std::uint64_t>()[1], 9007199254740993u);
  EXPECT_EQ(shape.find("_"), nullptr);
  EXPECT_EQ(write_text(write_pcd, shape), ascii);
}

TEST(Pcd, ReadsBinary) {
  const Shape shape = read_text(read_pcd, binary());
  expect_values(shape);
  EXPECT_EQ(write_text(write_pcd, shape), binary());
}

TEST(Pcd, ReadsCompressed) {
  const Shape shape = read_text(read_pcd, compressed());
  expect_values(shape);
  EXPECT_EQ(write_text(write_pcd, shape), compressed());
}

TEST(Pcd, ReplacesOnlyValuesThatChanged) {
  Shape shape = read_text(read_pcd, ascii);
  shape.positions[1].y() = 0.2F - shape.origin.y();
  shape.positions[1].z() = -4 - shape.origin.z();
  shape.find("far")->as<std::uint64_t>()[0] = 12;
  std::string expected = ascii;
  for (const auto& [old, now] :
       {std::pair<std::string, std::string>{" 0.1 ", " 0.2 "}, {" -0 ", " -4 "}, {"18446744073709551615", "12"}}) {
    ASSERT_NE(expected.find(old), std::string::npos) << old;
    expected.replace(expected.find(old), old.size(), now);
  }
  EXPECT_EQ(write_text(write_pcd, shape), expected);

  Shape moved = read_text(read_pcd, binary());
  moved.positions[2].y() = 77 - moved.origin.y();
  moved.find("normal")->as<float>()[0] = 1;
  std::string bytes = binary();
  const std::size_t begin = bytes.size() - binary_points().size();
  bytes.replace(begin + 2 * 56 + 4, 4, raw(77.0F));
  bytes.replace(begin + 20, 4, raw(1.0F));
  EXPECT_EQ(write_text(write_pcd, moved), bytes);
}

TEST(Pcd, RepacksWhatChangedWithTheSameValues) {
  Shape shape = read_text(read_pcd, compressed());
  shape.positions[2].y() = 77 - shape.origin.y();
  const std::string text = write_text(write_pcd, shape);
  EXPECT_TRUE(text.starts_with(compressed().substr(0, compressed().find("DATA"))));
  EXPECT_TRUE(text.ends_with("tail"));
  EXPECT_LT(text.size(), compressed().size());
  const Shape again = read_text(read_pcd, text);
  EXPECT_EQ(again.attributes, shape.attributes);
  for (std::size_t i = 0; i < shape.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double a = again.positions[i][c] + again.origin[c], b = shape.positions[i][c] + shape.origin[c];
      EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << i << ' ' << c;
    }
  EXPECT_EQ(write_text(write_pcd, again), text);
  EXPECT_EQ(write_text(write_pcd, shape), text);
}

TEST(Pcd, PacksEverySortOfRun) {
  // Lengths around the limits of LZF: literal runs of 32, matches of 8, 9 and 264, distances of 8192.
  std::string points;
  unsigned state = 1;
  const auto random = [&] { return static_cast<float>((state = state * 1664525 + 1013904223) >> 8); };
  for (int i = 0; i < 6000; ++i) {
    const float x = i % 700 < 300 ? 1.0F : random();
    points += raw(x, i % 2051 < 1025 ? static_cast<float>(i) : 0.5F, random());
  }
  const Shape plain = read_text(read_pcd, header("x y z", "4 4 4", "F F F", "1 1 1", 6000, 1, "binary") + points);
  std::string columns, packed;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < 6000; ++i) columns += points.substr(i * 12 + c * 4, 4);
  for (std::size_t i = 0; i < columns.size(); i += 32) {
    const std::string run = columns.substr(i, 32);
    packed += static_cast<char>(run.size() - 1) + run;
  }
  Shape shape = read_text(
      read_pcd, header("x y z", "4 4 4", "F F F", "1 1 1", 6000, 1, "binary_compressed") +
                    raw(static_cast<std::uint32_t>(packed.size()), static_cast<std::uint32_t>(columns.size())) +
                    packed);
  shape.positions[0].x() += 1;
  const std::string text = write_text(write_pcd, shape);
  EXPECT_LT(text.size(), columns.size());
  const Shape again = read_text(read_pcd, text);
  ASSERT_EQ(again.size(), plain.size());
  for (std::size_t i = 1; i < plain.size(); ++i)
    ASSERT_EQ(again.positions[i] + again.origin, plain.positions[i] + plain.origin) << i;
}

TEST(Pcd, OldHeadersHaveDefaults) {
  const Shape shape = read_text(read_pcd, "FIELDS x y z\nPOINTS 1\nDATA ascii\n1 2 3\n");
  EXPECT_EQ(shape.size(), 1u);
  EXPECT_EQ(read_text(read_pcd, "COLUMNS x y z\nWIDTH 0\nHEIGHT 1\nDATA binary_compressed\n").size(), 0u);
}

TEST(Pcd, KeepsAMillimetreFarFromTheOriginWhereTheFileHasDoubles) {
  const std::string head = header("x y z", "8 8 8", "F F F", "1 1 1", 2, 1, "binary");
  Shape shape = read_text(read_pcd, head + raw(5400000.0, 0.0, 0.0, 5400001.0, 1.0, 1.0));
  EXPECT_EQ(shape.position_type, Type::Float64);
  shape.positions[1].x() += 0.001;
  EXPECT_EQ(write_text(write_pcd, shape), head + raw(5400000.0, 0.0, 0.0, 5400001.001, 1.0, 1.0));
  EXPECT_TRUE(lost(write_pcd, shape).empty());
  Shape coarse =
      read_text(read_pcd, header("x y z", "4 4 4", "F F F", "1 1 1", 1, 1, "binary") + raw(5400000.0F, 0.0F, 0.0F));
  coarse.positions[0].x() += 0.125;
  EXPECT_EQ(lost(write_pcd, coarse),
            std::vector<std::string>{"The file's type of coordinates rounds moved points by up to 0.125."});
}

TEST(Pcd, RefusesInOneSentence) {
  const std::string good = header("x y z", "4 4 4", "F F F", "1 1 1", 1, 1, "binary");
  const std::string packed = header("x y z", "4 4 4", "F F F", "1 1 1", 1, 1, "binary_compressed");
  struct Case {
    std::string text, sentence;
  };
  const Case cases[] = {
      {"", "test: expected a PCD header, found an empty file"},
      {"FIELDS x y z\n", "test:2: expected a header line with DATA, found the end of the file"},
      {"ply\n", "test:1:1: expected a keyword of a PCD header, found \"ply\""},
      {"SIZE 4 4 4\n", "test:1:1: expected FIELDS before it, found \"SIZE\""},
      {"DATA ascii\n", "test:1:1: expected FIELDS before it, found \"DATA\""},
      {"FIELDS x y z\nFIELDS x y\n", "test:2:1: expected one line of FIELDS, found \"FIELDS\""},
      {"FIELDS x y z\nSIZE 4 4\n", "test:2:9: expected a value for each of the 3 fields, found the end of the line"},
      {"FIELDS x y z\nSIZE 4 4 4 4\n", "test:2:12: expected a value for each of the 3 fields, found \"4\""},
      {"FIELDS x y z\nSIZE 4 4 16\n", "test:2:10: expected a size of 1, 2, 4 or 8, found \"16\""},
      {"FIELDS x y z\nTYPE F F D\n", "test:2:10: expected a type of I, U or F, found \"D\""},
      {"FIELDS x y z\nSIZE 4 4 2\nPOINTS 0\nDATA ascii\n",
       "test:2: expected a TYPE I or U of SIZE 1, 2, 4 or 8, or F of 4 or 8, found F of 2 for field \"z\""},
      {"FIELDS x y z\nCOUNT 1 1 0\n", "test:2:11: expected a count of 1 to 65536, found \"0\""},
      {"FIELDS x y z\nCOUNT 1 1 99999999999999999999\n",
       "test:2:11: expected a count of 1 to 65536, found \"99999999999999999999\""},
      {"FIELDS x y z a\nCOUNT 1 1 1 65534\nPOINTS 0\nDATA ascii\n",
       "test: expected at most 65536 values a point, found 65537"},
      {"FIELDS x y z\nWIDTH -1\n", "test:2:7: expected the width (0 to 4294967294), found \"-1\""},
      {"FIELDS x y z\nDATA ascii\n", "test: expected a header with WIDTH or POINTS, found neither"},
      {"FIELDS x y z\nWIDTH 2\nHEIGHT 3\nPOINTS 5\nDATA ascii\n",
       "test:4: expected POINTS as WIDTH x HEIGHT (6), found 5"},
      {"FIELDS x y z\nWIDTH 4294967294\nHEIGHT 4294967294\nDATA ascii\n",
       "test: expected fewer than 2^32 - 1 points, found 18446744056529682436"},
      {"FIELDS x y z\nPOINTS 4000000000\nDATA ascii\n1 2 3\n",
       "test: byte 42: expected 4000000000 points of at least 6 bytes, found only 6 bytes to the end of the file"},
      {"FIELDS x y z\nPOINTS 4000000000\nDATA binary\n1 2 3\n",
       "test: byte 43: expected 4000000000 points of at least 12 bytes, found only 6 bytes to the end of the file"},
      {good + "12345678901", "test: byte " + std::to_string(good.size()) +
                                 ": expected 12 bytes of points, found only 11 bytes to the end of the file"},
      {"FIELDS x y z\nPOINTS 1\nDATA zip\n", "test:3:6: expected ascii, binary or binary_compressed, found \"zip\""},
      {"FIELDS x y w\nPOINTS 0\nDATA ascii\n",
       "test: expected fields x, y and z of one value each, found none such in the header"},
      {"FIELDS x y z\nPOINTS 1\nDATA ascii\n1 2 1.#IND\n",
       "test:4:5: expected a value of type float32 for field \"z\", found \"1.#IND\""},
      {"FIELDS x y z a\nTYPE F F F U\nSIZE 4 4 4 1\nPOINTS 1\nDATA ascii\n1 2 3 256\n",
       "test:6:7: expected a value of type uint8 for field \"a\", found \"256\""},
      {"FIELDS x y z\nPOINTS 2\nDATA ascii\n1 2\n1 2 3 4\n",
       "test:4:4: expected a value of type float32 for field \"z\", found the end of the line"},
      {"FIELDS x y z\nPOINTS 1\nDATA ascii\n1 2 3 4\n",
       "test:4:7: expected the end of a line of 3 values, found \"4\""},
      {"FIELDS x y z\nPOINTS 2\nDATA ascii\n1.000 2.000 3.000\n",
       "test:5:1: expected point 2 of 2, found the end of the file"},
      {"FIELDS x y z\nPOINTS 1\nDATA ascii\n1 2 3\n\n4 5 6\n",
       "test:6:1: expected the end of the file after 1 points, found \"4\""},
      {packed + "123", "test: byte " + std::to_string(packed.size()) +
                           ": expected 4 bytes of the size of the packed data, found the end of the file after 3"},
      {packed + raw(std::uint32_t{1}, std::uint32_t{13}) + "x",
       "test: byte " + std::to_string(packed.size() + 4) + ": expected 12 unpacked bytes for 1 points, found 13"},
      {packed + raw(std::uint32_t{9}, std::uint32_t{12}) + "x",
       "test: byte " + std::to_string(packed.size() + 8) +
           ": expected 9 bytes of packed data, found the end of the file after 1"},
      {packed + raw(std::uint32_t{1}, std::uint32_t{12}) + "x",
       "test: byte " + std::to_string(packed.size() + 8) +
           ": expected LZF data that unpack to 12 bytes, found data for 5"},
      {packed + raw(std::uint32_t{3}, std::uint32_t{12}) + "\xe0\x03\x10",
       "test: byte " + std::to_string(packed.size() + 8) +
           ": expected LZF data that unpack to 12 bytes, found damaged data"},
  };
  for (const Case& c : cases) EXPECT_EQ(refusal(read_pcd, c.text), c.sentence) << c.text;
  // Sizes that agree with each other but not with what so few bytes can hold.
  const std::string huge = header("x y z", "8 8 8", "F F F", "1 1 1", 100000, 1000, "binary_compressed");
  EXPECT_EQ(refusal(read_pcd, huge + raw(std::uint32_t{1000}, std::uint32_t{2400000000}) + std::string(1000, '\xff')),
            "test: byte " + std::to_string(huge.size() + 8) +
                ": expected LZF data that unpack to 2400000000 bytes, found data for 87921");
}

TEST(Pcd, ManyFieldsOfOneNameAreNoTrap) {
  std::string names = "FIELDS x y z";
  for (int i = 0; i < 1021; ++i) names += " a";
  const Shape shape = read_text(read_pcd, names + "\nPOINTS 0\nDATA ascii\n");
  EXPECT_EQ(shape.attributes.size(), 1021u);
  EXPECT_EQ(shape.attributes.back().name, "a 1021");
  EXPECT_EQ(refusal(read_pcd, names + " a\n"), "test:1:2056: expected at most 1024 fields, found \"a\"");
}

TEST(Pcd, WritesWhatAnotherFormatHeld) {
  Shape shape;
  shape.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0.1f)};
  Attribute color{"color", {"red", "green", "blue"}, Kind::Color, Type::UInt8, 3, {}, {}, {}};
  color.values = bytes_of("\x01\x33\x02\x05\x01\x33");
  Attribute normal{"normal", {"x", "y", "z"}, Kind::Normal, Type::Float32, 3, {}, {}, {}};
  normal.values.resize(24);
  Attribute odd{"odd one", {"a", "b"}, Kind::Scalar, Type::Int8, 2, {}, {}, {}};
  odd.values = bytes_of("1234");
  Attribute facet{"facet", {"f"}, Kind::Scalar, Type::Int8, 1, bytes_of("1"), {0, 1}, {0}};
  shape.attributes = {color, normal, odd, facet};
  shape.faces.add(std::vector<Index>{0, 1, 0});
  const std::string text = write_text(write_pcd, shape);
  const std::string head =
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb normal_x normal_y normal_z odd_one\n"
      "SIZE 4 4 4 4 4 4 4 1\nTYPE F F F U F F F I\nCOUNT 1 1 1 1 1 1 1 2\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
      "POINTS 2\nDATA binary\n";
  EXPECT_EQ(text, head + raw(0.0F, 0.0F, 0.0F, std::uint32_t{0xff013302}, 0.0F, 0.0F, 0.0F) + "12" +
                      raw(1.0F, 0.0F, 0.1F, std::uint32_t{0xff050133}, 0.0F, 0.0F, 0.0F) + "34");
  EXPECT_EQ(lost(write_pcd, shape),
            (std::vector<std::string>{"PCD cannot hold the attribute \"facet\".", "PCD cannot hold the 1 face."}));
  EXPECT_EQ(write_text(write_pcd, read_text(read_pcd, text)), text);
}

TEST(Pcd, DamagedFilesAreRefusedOrExact) {
  SHARED_DATA(folder, "malformed");
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".pcd") {
      expect_refused_or_exact(read_pcd, write_pcd, entry.path().string());
      ++files;
    }
  EXPECT_GE(files, 1);
}

TEST(Pcd, RealFilesComeBackExactly) {
  SHARED_DATA(folder, "scans");
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".pcd") continue;
    ++files;
    expect_exact(read_pcd, write_pcd, entry.path().string());
  }
  EXPECT_GE(files, 9);
}

}  // namespace
}  // namespace sinew::io
