#include "engine/io/stl.h"

#include <array>

#include "engine/io/bytes.h"
#include "engine/io/stl_content.h"
#include "engine/io/text_patch.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

constexpr std::size_t progress_facets = 1 << 16;

bool starts_with_solid(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos || text.size() - begin < 5) return false;
  return StlText::is_word(text.substr(begin, 5), "solid");
}

/// Binary by its size; failing that, text begins with "solid" and has no zero byte where a binary header would have.
bool is_binary(const std::string& path, std::span<const std::byte> bytes) {
  const bool solid = starts_with_solid(as_text(bytes));
  if (bytes.size() >= stl_header) {
    const auto count = stl_count(bytes);
    if (bytes.size() == stl_header + stl_facet * count) return true;
    return !solid || as_text(bytes).substr(0, stl_header).find('\0') != std::string_view::npos;
  }
  if (!solid)
    throw file_error(path, "an STL file (\"solid\" or a header of 84 bytes)",
                     bytes.empty() ? "an empty file" : quoted(as_text(bytes).substr(0, 16)));
  return false;
}

/// Facets of three points each, and the places of their normals.
void add_facets(Shape& shape, std::size_t count) {
  for (std::size_t f = 0; f < count; ++f) {
    const auto first = static_cast<Index>(3 * f);
    shape.faces.add(std::array{first, first + 1, first + 2});
  }
}

void add_normals(Shape& shape, Attribute normal) {
  normal.name = "normal";
  normal.fields = {"nx", "ny", "nz"};
  normal.kind = Kind::Normal;
  normal.components = 3;
  normal.point_offsets = shape.faces.offsets;
  normal.points = shape.faces.points;
  shape.attributes.push_back(std::move(normal));
}

Shape read_binary(const std::string& path, std::span<const std::byte> bytes, const ReadOptions& options) {
  constexpr bool swap = std::endian::native != std::endian::little;
  const std::size_t count = stl_count(bytes);
  ByteCursor cursor(path, bytes, stl_header);
  cursor.check_count(count, stl_facet, "facets");
  Shape shape;
  shape.positions.resize(3 * count);
  Attribute normal;
  normal.values.resize(count * 3 * sizeof(float));
  std::size_t marked = 0;
  for (std::size_t f = 0; f < count; ++f) {
    const std::byte* at = bytes.data() + stl_header + f * stl_facet;
    for (std::size_t c = 0; c < 3; ++c)
      store(normal.values.data() + (3 * f + c) * sizeof(float), load<std::uint32_t>(at + 4 * c, swap), false);
    for (std::size_t c = 0; c < 9; ++c)
      shape.positions[3 * f + c / 3][c % 3] = static_cast<double>(load<float>(at + 12 + 4 * c, swap));
    if (load<std::uint16_t>(at + 48, swap) != 0) ++marked;
    if (f % progress_facets == 0) report_progress(options, f, count);
  }
  add_facets(shape, count);
  add_normals(shape, std::move(normal));
  if (marked > 0)
    shape.notes.push_back("The attribute bytes of " + counted(marked, "facet", "facets") + " are kept but not used.");
  if (const std::size_t left = cursor.left() - count * stl_facet; left > 0)
    shape.notes.push_back(counted(left, "byte", "bytes") + " after the last facet are kept but not read.");
  return shape;
}

Shape read_ascii(const std::string& path, std::span<const std::byte> bytes, const ReadOptions& options) {
  std::vector<double> normals, points;
  Precision position_precision(float_limit), normal_precision;
  StlText text(path, bytes);
  for (StlText::Facet facet; text.next(facet);) {
    for (std::size_t c = 0; c < 12; ++c) {
      const double x = text.number(facet[c]);
      (c < 3 ? normals : points).push_back(x);
      (c < 3 ? normal_precision : position_precision).see(facet[c].text, x);
    }
    if (points.size() % (9 * progress_facets) == 0) report_progress(options, text.at(), bytes.size());
  }
  Shape shape;
  shape.position_type = position_precision.type();
  shape.positions.resize(points.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    shape.positions[i / 3][static_cast<int>(i % 3)] = as_read(points[i], shape.position_type);
  add_facets(shape, points.size() / 9);
  add_normals(shape, number_attribute("normal", {"nx", "ny", "nz"}, Kind::Normal, normal_precision.type(), normals));
  if (text.solids() > 1) shape.notes.push_back("The names of " + std::to_string(text.solids()) + " solids are kept.");
  return shape;
}

}  // namespace

std::uint32_t stl_count(std::span<const std::byte> bytes) {
  return load<std::uint32_t>(bytes.data() + stl_header - 4, std::endian::native != std::endian::little);
}

bool StlText::is_word(std::string_view text, std::string_view word) {
  const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; };
  return std::equal(text.begin(), text.end(), word.begin(), word.end(), same);
}

Token StlText::next_token(const char* expected) {
  Token token = cursor_.next();
  if (token.text.empty()) throw text_error(path_, token.line, token.column, expected, "the end of the file");
  return token;
}

void StlText::expect(const char* word) {
  const Token token = next_token(word);
  if (!is_word(token.text, word)) throw cursor_.error(token, word);
}

double StlText::number(const Token& token) const {
  double x = 0;
  if (!parse(token.text, x)) throw cursor_.error(token, "a number");
  return x;
}

bool StlText::next(Facet& facet) {
  for (;;) {
    if (!in_solid_) {
      const Token token = cursor_.next();
      if (token.text.empty()) return false;
      if (!is_word(token.text, "solid")) throw cursor_.error(token, "solid");
      cursor_.rest();
      in_solid_ = true;
      ++solids_;
    }
    const Token token = next_token("facet or endsolid");
    if (is_word(token.text, "facet")) break;
    if (!is_word(token.text, "endsolid")) throw cursor_.error(token, "facet or endsolid");
    cursor_.rest();
    in_solid_ = false;
  }
  expect("normal");
  for (std::size_t c = 0; c < 3; ++c) facet[c] = next_token("a number");
  expect("outer");
  expect("loop");
  for (std::size_t c = 3; c < 12; ++c) {
    if (c % 3 == 0) expect("vertex");
    facet[c] = next_token("a number");
  }
  expect("endloop");
  expect("endfacet");
  return true;
}

Shape read_stl(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options) {
  auto content = std::make_shared<StlContent>();
  content->bytes = std::move(bytes);
  content->binary = is_binary(path, content->bytes);
  Shape shape =
      content->binary ? read_binary(path, content->bytes, options) : read_ascii(path, content->bytes, options);
  shape.content = std::move(content);
  return shape;
}

}  // namespace sinew::io
