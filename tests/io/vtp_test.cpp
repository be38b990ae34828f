#include "engine/io/vtp.h"

#include <gtest/gtest.h>

#include "engine/io/xml_scanner.h"
#include "tests/io/file_checks.h"

namespace sinew::io {
namespace {

template <class T>
std::string raw(std::initializer_list<T> values, bool swap = false) {
  std::string out;
  for (const T x : values) {
    const auto* bytes = reinterpret_cast<const char*>(&x);
    std::string value(bytes, bytes + sizeof(T));
    if (swap) std::reverse(value.begin(), value.end());
    out += value;
  }
  return out;
}

std::string base64(const std::string& bytes) {
  static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < 3; ++b)
      bits = bits << 8 | (i + b < bytes.size() ? static_cast<unsigned char>(bytes[i + b]) : 0);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  return out;
}

const char* const ascii =
    "<?xml version='1.0'?>\r\n<!-- a <comment> -->\n"
    "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order = 'BigEndian'>\n"
    " <PolyData>\n"
    "  <FieldData><DataArray type=\"String\" Name=\"s\" format=\"ascii\">65 0</DataArray></FieldData>\n"
    "  <Piece NumberOfPoints=\"3\" NumberOfVerts=\"0\" NumberOfLines=\"1\" NumberOfStrips=\"0\" NumberOfPolys=\"1\">\n"
    "   <PointData Vectors=\"f &amp; g\" Normals=\"up\">\n"
    "    <DataArray type=\"Int32\" Name=\"id\" format=\"ascii\"> 7 8 9</DataArray>\n"
    "    <DataArray type=\"Float64\" Name=\"f &amp; g\" NumberOfComponents=\"3\" format=\"ascii\">\n"
    "     <InformationKey name=\"k\"><Value index=\"0\">1</Value></InformationKey>\n"
    "     1 0 0\n     0 1 0\n     0 0 1.50</DataArray>\n"
    "    <DataArray type=\"Float32\" Name=\"up\" NumberOfComponents=\"3\">0 0 1 0 0 1 0 0 1</DataArray>\n"
    "   </PointData>\n"
    "   <CellData/>\n"
    "   <Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0.50 0 0 1 0 0 0 1 0</DataArray>"
    "</Points>\n"
    "   <Polys>\n"
    "    <DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray>\n"
    "    <DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3</DataArray>\n"
    "   </Polys>\n"
    "  </Piece>\n </PolyData>\n</VTKFile>\n";

TEST(Vtp, ReadsAscii) {
  const Shape shape = read_text(read_vtp, ascii);
  expect_sound(shape, "ascii");
  ASSERT_EQ(shape.size(), 3u);
  EXPECT_EQ(shape.positions[0], Vec3(0.5, 0, 0));
  EXPECT_EQ(shape.faces.points, (std::vector<Index>{0, 1, 2}));
  ASSERT_TRUE(shape.find("id") && shape.find("f & g") && shape.find("normal"));
  EXPECT_EQ(shape.find("f & g")->kind, Kind::Vector);
  EXPECT_EQ(shape.find("f & g")->number(2, 2), 1.5);
  EXPECT_EQ(shape.find("normal")->kind, Kind::Normal);
  EXPECT_EQ(shape.notes,
            (std::vector<std::string>{"Kept in the VTK file only: 1 cell that is neither polygon nor tet.",
                                      "Kept in the VTK file only: 1 array that is not of the points' numbers."}));
}

TEST(Vtp, ReplacesOnlyTokensThatChanged) {
  Shape shape = read_text(read_vtp, ascii);
  EXPECT_EQ(write_text(write_vtp, shape), ascii);
  shape.positions[0].x() = 0.75;
  shape.find("f & g")->set_number(2, 2, 0.1);
  shape.find("id")->set_number(2, 0, 10);
  std::string expected = ascii;
  for (const auto& [old, now] :
       {std::pair<std::string, std::string>{">0.50 ", ">0.75 "}, {"1.50<", "0.1<"}, {"8 9<", "8 10<"}}) {
    ASSERT_NE(expected.find(old), std::string::npos) << old;
    expected.replace(expected.find(old), old.size(), now);
  }
  EXPECT_EQ(write_text(write_vtp, shape), expected);
}

/// Two points and a velocity in a form: "base64", "appended raw" or "appended base64".
std::string file(const std::string& form, bool big, bool wide) {
  const auto block = [&](const std::string& values) {
    const auto size = static_cast<std::uint32_t>(values.size());
    return (wide ? raw<std::uint64_t>({size}, big) : raw<std::uint32_t>({size}, big)) + values;
  };
  std::string points = block(raw<double>({1, 2, 3, 4, 5, 6}, big)), v = block(raw<float>({0.5F, 0, 0, 0, 1, 0}, big));
  if (form != "appended raw") points = base64(points), v = base64(v);
  const bool appended = form != "base64";
  const auto array = [&](const char* type, const char* name, const std::string& data, std::size_t offset) {
    return std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"3\" format=\"" +
           (appended ? "appended\" offset=\"" + std::to_string(offset) + "\"/>"
                     : "binary\">\n  " + data + "\n </DataArray>");
  };
  std::string out = std::string("<VTKFile type=\"PolyData\" byte_order=\"") + (big ? "Big" : "Little") +
                    "Endian\" header_type=\"UInt" + (wide ? "64" : "32") +
                    "\"><PolyData><Piece NumberOfPoints=\"2\"><Points>" + array("Float64", "p", points, v.size()) +
                    "</Points><PointData>" + array("Float32", "v", v, 0) + "</PointData></Piece></PolyData>";
  if (appended)
    out += std::string("<AppendedData encoding=\"") + (form == "appended raw" ? "raw" : "base64") + "\">\n _" + v +
           points + "\n</AppendedData>";
  return out + "</VTKFile>\n";
}

TEST(Vtp, ReadsEveryFormOfBytes) {
  for (const char* form : {"base64", "appended raw", "appended base64"})
    for (const bool big : {false, true})
      for (const bool wide : {false, true}) {
        const std::string text = file(form, big, wide);
        const Shape shape = read_text(read_vtp, text);
        expect_sound(shape, form);
        ASSERT_EQ(shape.size(), 2u) << form;
        EXPECT_EQ(shape.positions[1], Vec3(4, 5, 6)) << form;
        ASSERT_TRUE(shape.find("velocity")) << form;
        EXPECT_EQ(shape.find("velocity")->number(1, 1), 1) << form;
        EXPECT_EQ(write_text(write_vtp, shape), text) << form;
        Shape moved = shape;
        moved.positions[1] = Vec3(0.1, 1e9, -7);
        moved.find("velocity")->set_number(0, 2, 0.1);
        const std::string after = write_text(write_vtp, moved);
        EXPECT_EQ(after.size(), text.size()) << form;
        const Shape again = read_text(read_vtp, after);
        EXPECT_EQ(again.positions[0] + again.origin, Vec3(1, 2, 3)) << form;
        EXPECT_EQ(again.positions[1] + again.origin, Vec3(0.1, 1e9, -7)) << form;
        EXPECT_EQ(again.find("velocity")->values, moved.find("velocity")->values) << form;
      }
}

TEST(Vtp, AnyCutIsRefused) {
  for (const char* form : {"base64", "appended raw", "appended base64"}) {
    const std::string good = file(form, false, false);
    for (std::size_t size = 0; size < good.size(); ++size) {
      const std::string cut = good.substr(0, size), sentence = refusal(read_vtp, cut);
      // The appended data end the walk: what follows them is not looked at.
      if (sentence == "read") {
        EXPECT_EQ(write_text(write_vtp, read_text(read_vtp, cut)), cut);
      } else {
        EXPECT_NE(sentence.find(": expected "), std::string::npos) << sentence;
      }
    }
  }
}

std::string replaced(std::string text, const std::string& old, const std::string& now) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return at == std::string::npos ? text : text.replace(at, old.size(), now);
}

TEST(Vtp, RefusesInOneSentence) {
  const std::string good = file("appended raw", false, false), coded = file("base64", false, false);
  struct Case {
    std::string text, sentence;
  };
  const Case cases[] = {
      {"", "test: expected an XML file of VTK, found an empty file"},
      {"no XML", "test:1:7: expected an element VTKFile, found the end of the file"},
      {"<!DOCTYPE a>", "test:1:1: expected the tag of an element, found \"<!DOCTYPE\""},
      {"<svg>", "test:1:1: expected one element VTKFile, found \"svg\""},
      {"<VTKFile type=PolyData>",
       "test:1:1: expected attributes such as name=\"value\" in the tag \"VTKFile\", found \"type=PolyData>\""},
      {"<VTKFile type=\"a\"", "test:1:1: expected \">\" at the end of the tag \"VTKFile\", found the end of the file"},
      {"<VTKFile type=\"a&b;\">",
       "test:1:1: expected an entity such as &amp; or &#65; in the tag \"VTKFile\", found \"&b;\""},
      {"<VTKFile type=\"ImageData\">",
       "test:1:1: expected a VTKFile of type PolyData or UnstructuredGrid, found \"ImageData\""},
      {"<VTKFile type=\"PolyData\"><a></b>", "test:1:29: expected the end of the element \"a\", found \"</b\""},
      {"<VTKFile type=\"PolyData\">",
       "test:1:26: expected the end of the element \"VTKFile\", found the end of the file"},
      {"<VTKFile type=\"PolyData\"/>", "test: expected an element Piece, found none"},
      {"<!-- no end", "test:1:1: expected \"-->\" behind \"<!--\", found the end of the file"},
      {replaced(good, "UInt32", "UInt16"), "test:1:1: expected a header_type of UInt32 or UInt64, found \"UInt16\""},
      {replaced(good, "Little", "Middle"),
       "test:1:1: expected a byte_order of LittleEndian or BigEndian, found \"MiddleEndian\""},
      {replaced(good, "</Piece>", "</Piece><Piece>"), "test:1:334: expected one Piece, found another"},
      {replaced(good, "NumberOfPoints=\"2\"", ""), "test:1:83: expected a whole number as NumberOfPoints, found none"},
      {replaced(good, "NumberOfPoints=\"2\"", "NumberOfPoints=\"4000000000\""),
       "test: byte 413: expected a length of the array \"p\" of 96000000000 bytes, found 48"},
      {replaced(good, "Points=\"2\"", "Points=\"3\""),
       "test: byte 404: expected a length of the array \"p\" of 72 bytes, found 48"},
      {replaced(good, "offset=\"28\"", "offset=\"9999\""),
       "test:1:117: expected an offset within the 107 bytes from the appended data to the end of the file, found 9999"},
      {replaced(good, "offset=\"28\"", "offset=\"0\""),
       "test: byte 375: expected a length of the array \"p\" of 48 bytes, found 24"},
      {replaced(good, "Name=\"p\" NumberOfComponents=\"3\"", "Name=\"p\" NumberOfComponents=\"6\""),
       "test: byte 404: expected a length of the array \"p\" of 96 bytes, found 48"},
      {replaced(good, ">\n _", ">\n -"), "test:1:345: expected \"_\" in front of the appended data, found \"-\""},
      {replaced(coded, "Float64", "Float16"), "test:1:117: expected a type such as Float32, found \"Float16\""},
      {replaced(coded, "\"binary\"", "\"hex\""),
       "test:1:117: expected a format of ascii, binary or appended, found \"hex\""},
      {replaced(coded, "MAAA", "M*AA"), "test: byte 194: expected a character of base64, found \"*\""},
      {replaced(ascii, "1.50<", "1.5x<"),
       "test:13:10: expected value 9 of 9 of the array \"f & g\", of type float64, found \"1.5x\""},
      {replaced(ascii, "1.50<", "<"),
       "test:13:10: expected value 9 of 9 of the array \"f & g\", of type float64, found the end of the data"},
      {replaced(ascii, "1.50<", "1.50 2<"),
       "test:13:15: expected the end of the array \"f & g\" after 9 values, found \"2\""},
      {replaced(ascii, ">0 1 2<", ">0 1 3<"), "test:19:5: expected the numbers from 0 of some of 3 points, found 3"},
      {replaced(ascii, ">3</", ">-3</"), "test:20:5: expected offsets that ascend from 0, found others"},
      {replaced(ascii, ">3</", ">2000000000</"),
       "test: byte 957: expected 2000000000 rows of the array \"connectivity\" of 1 value, found only 5 bytes"},
  };
  for (const Case& c : cases) EXPECT_EQ(refusal(read_vtp, c.text), c.sentence) << c.text;
}

TEST(Vtp, RefusesArraysThatOverlap) {
  // Both arrays are of the same bytes.
  std::string text = file("appended raw", false, false);
  text = replaced(text, "Float64\" Name=\"p\"", "Float32\" Name=\"p\"");
  text = replaced(text, "offset=\"28\"", "offset=\"0\"");
  const std::string sentence = refusal(read_vtp, text);
  EXPECT_NE(sentence.find("expected arrays that do not overlap, found one that begins within another"),
            std::string::npos)
      << sentence;
}

TEST(Vtp, WritesWhatAnotherFormatHeld) {
  Shape shape;
  shape.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0.1f), Vec3(0, 1, 0)};
  Attribute odd{"an <odd> & \"one\"", {"odd"}, Kind::Scalar, Type::Float64, 1, {}, {}, {}};
  odd.values.resize(24);
  odd.set_number(1, 0, 0.1);
  Attribute shared{"shared", {"shared"}, Kind::Scalar, Type::Float32, 1, {}, {0, 2}, {0, 1}};
  shared.values.resize(4);
  shape.attributes = {odd, shared};
  for (const WriteFunction write : {write_vtp, write_vtu}) {
    EXPECT_EQ(lost(write, shape).size(), 1u);
    for (const bool faces : {false, true}) {
      shape.faces = {};
      if (faces) shape.faces.add(std::vector<Index>{0, 1, 2});
      const std::string text = write_text(write, shape);
      const Shape again = read_text(read_vtp, text);
      EXPECT_EQ(again.positions, shape.positions);
      EXPECT_EQ(again.faces.points, shape.faces.points);
      ASSERT_TRUE(again.find("an <odd> & \"one\""));
      EXPECT_EQ(again.find("an <odd> & \"one\"")->number(1, 0), 0.1);
      EXPECT_TRUE(again.notes.empty());
      EXPECT_EQ(write_text(write, again), text);
    }
  }
  // A PolyData is no UnstructuredGrid: a new file is made.
  EXPECT_NE(write_text(write_vtu, read_text(read_vtp, ascii)).find("<UnstructuredGrid>"), std::string::npos);
}

TEST(Xml, WalksOverTags) {
  XmlScanner scanner("test", "<?a?>\n<one a='1' b = \"&lt;&#65;&#x42;\"> text <!-- <no> --> <two/></one>");
  XmlTag tag = scanner.next();
  EXPECT_EQ(tag.name, "one");
  EXPECT_EQ(tag.line, 2);
  EXPECT_TRUE(tag.opens && !tag.closes);
  EXPECT_EQ(tag.value("a"), "1");
  EXPECT_EQ(tag.value("b"), "<AB");
  EXPECT_EQ(tag.value("c", "none"), "none");
  tag = scanner.next();
  EXPECT_EQ(tag.name, "two");
  EXPECT_TRUE(tag.opens && tag.closes);
  tag = scanner.next();
  EXPECT_TRUE(!tag.opens && tag.closes);
  EXPECT_TRUE(scanner.next().name.empty());
}

std::string grid(const std::string& corners, const std::string& ends, const std::string& types, int cells) {
  return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"5\" NumberOfCells=\"" +
         std::to_string(cells) +
         "\">\n<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">0.50 0 0 1 0 0 0 1 0 0 0 1 1 1 "
         "1</DataArray>"
         "</Points>\n<Cells>\n<DataArray type=\"Int32\" Name=\"connectivity\">" +
         corners + "</DataArray><DataArray type=\"Int32\" Name=\"offsets\">" + ends +
         "</DataArray><DataArray type=\"UInt8\" Name=\"types\">" + types +
         "</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>";
}

TEST(Vtu, ReadsAndWritesTetsAndFaces) {
  const std::string text = grid("0 1 2 3 0 1 2 0 1 4 2 0 1", "4 7 11 13", "10 5 9 3", 4);
  Shape shape = read_text(read_vtp, text);
  expect_sound(shape, "grid");
  EXPECT_EQ(shape.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
  EXPECT_EQ(shape.faces.points, (std::vector<Index>{0, 1, 2, 0, 1, 4, 2}));
  EXPECT_EQ(shape.notes,
            std::vector<std::string>{"Kept in the VTK file only: 1 cell that is neither polygon nor tet."});
  EXPECT_EQ(write_text(write_vtu, shape), text);
  shape.content = nullptr;
  for (const bool faces : {true, false}) {
    if (!faces) shape.faces = {};
    const Shape again = read_text(read_vtp, write_text(write_vtu, shape));
    EXPECT_EQ(again.tets, shape.tets);
    EXPECT_EQ(again.faces.points, shape.faces.points);
    EXPECT_EQ(again.positions, shape.positions);
    EXPECT_TRUE(again.notes.empty());
  }
  EXPECT_TRUE(read_text(read_vtp, write_text(write_vtp, shape)).tets.empty());
}

TEST(Vtu, RefusesTetsThatAreNone) {
  EXPECT_EQ(refusal(read_vtp, grid("0 1 2 5", "4", "10", 1)),
            "test:4:1: expected the numbers from 0 of some of 5 points, found 5");
  EXPECT_EQ(refusal(read_vtp, grid("0 1 2 3 0 1 2 1", "4 8", "10 10", 2)),
            "test:4:1: expected four different points of the tet that is cell 1, found point 1 twice");
  EXPECT_EQ(refusal(read_vtp, grid("0 1 2", "3", "10", 1)),
            "test:4:1: expected four different points of the tet that is cell 0, found one of 3 points");
}

}  // namespace
}  // namespace sinew::io
