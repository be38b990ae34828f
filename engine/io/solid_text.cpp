#include "engine/io/solid_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/io/bytes.h"

namespace sinew::io {

std::string SolidRow::text() const {
  return std::string(what) + " " + std::to_string(i + 1) + " of " + std::to_string(n);
}

SolidReader::SolidReader(const std::string& path, std::span<const std::byte> bytes, const ReadOptions& options,
                         char comment)
    : path_(path),
      text_(as_text(bytes)),
      options_(options),
      comment_(comment),
      cursor_(path, text_, text_begin(path, bytes)) {}

InputError SolidReader::error(const Token& t, const std::string& expected) const {
  if (t.text.empty() && cursor_.at_end()) return text_error(path_, t.line, t.column, expected, "the end of the file");
  return cursor_.error(t, expected);
}

std::int64_t SolidReader::integer(Token& t, const char* expected) {
  t = next();
  std::int64_t x = 0;
  if (!parse(t.text, x)) throw error(t, expected);
  return x;
}

std::size_t SolidReader::count(const char* of, std::size_t smallest) {
  const Token t = next();
  std::int64_t count = 0;
  if (!parse(t.text, count) || count < 0) throw error(t, std::string("the count of ") + of);
  const auto size = static_cast<std::size_t>(count);
  const std::size_t left = text_.size() - cursor_.at();
  // The last row needs no end of its line.
  if (size >= no_row || size > (left + 1) / smallest)
    throw error(t, std::string("a count of ") + of + " that fits into the " + std::to_string(left) + " bytes left");
  return size;
}

double SolidReader::number(const SolidRow& row, Precision& precision) {
  const Token t = next();
  double x = 0;
  if (!parse(t.text, x)) throw error(t, "a number of " + row.text());
  precision.see(t.text, x);
  return x;
}

void SolidReader::point(const SolidRow& row, Shape& shape, SolidContent& content) {
  Vec3 p;
  for (int c = 0; c < 3; ++c) {
    const Token t = next();
    if (!parse(t.text, p[c])) throw error(t, "a number of " + row.text());
    precision_.see(t.text, p[c]);
    if (c == 0) content.points.push_back(t.begin);
  }
  shape.positions.push_back(p);
}

void SolidReader::finish_points(Shape& shape) const {
  shape.position_type = precision_.type();
  for (Vec3& p : shape.positions)
    for (int c = 0; c < 3; ++c) p[c] = as_read(p[c], shape.position_type);
}

Index SolidReader::corner(const SolidRow& row, std::size_t points, std::int64_t first, Token& t) {
  t = next();
  std::int64_t x = 0;
  const std::int64_t last = first + static_cast<std::int64_t>(points) - 1;
  if (!parse(t.text, x) || x < first || x > last)
    throw error(t, points == 0 ? "points before " + row.text()
                               : "the index of a point (" + std::to_string(first) + " to " + std::to_string(last) +
                                     ") in " + row.text());
  return static_cast<Index>(x - first);
}

void SolidReader::face(const SolidRow& row, Shape& shape, std::size_t size, std::int64_t first) {
  std::array<Index, 4> corners{};
  CHECK(size <= corners.size(), size);
  Token t;
  for (std::size_t c = 0; c < size; ++c) corners[c] = corner(row, shape.size(), first, t);
  add_solid_face(path_, shape, std::span(corners).first(size));
}

void SolidReader::tet(const SolidRow& row, Shape& shape, std::int64_t first) {
  Tet tet{};
  std::array<Token, 4> places;
  for (std::size_t c = 0; c < 4; ++c) tet[c] = corner(row, shape.size(), first, places[c]);
  const std::size_t again = repeated_corner(tet);
  if (again < 4) throw error(places[again], "four different points in " + row.text());
  shape.tets.push_back(tet);
}

void SolidReader::progress(std::size_t row) const {
  if (row % 65536 == 0) report_progress(options_, cursor_.at(), text_.size());
}

void add_solid_face(const std::string& path, Shape& shape, std::span<const Index> corners) {
  if (corners.size() >= no_row - shape.faces.points.size())
    throw file_error(path, "fewer than 2^32 corners of faces", "more");
  shape.faces.add(corners);
}

std::size_t repeated_corner(const Tet& tet) {
  for (std::size_t c = 1; c < 4; ++c)
    if (std::find(tet.begin(), tet.begin() + static_cast<std::ptrdiff_t>(c), tet[c]) !=
        tet.begin() + static_cast<std::ptrdiff_t>(c))
      return c;
  return 4;
}

void keep_solid(Shape& shape, std::shared_ptr<SolidContent> content) {
  content->faces = shape.faces.size();
  content->corners = shape.faces.points.size();
  content->tets = shape.tets.size();
  for (const Attribute& attribute : shape.attributes) content->attributes.push_back(attribute.name);
  shape.content = std::move(content);
}

bool fits_solid(const Shape& shape, const SolidContent& content) {
  return content.points.size() == shape.size() && content.faces == shape.faces.size() &&
         content.corners == shape.faces.points.size() && content.tets == shape.tets.size() &&
         std::all_of(content.attributes.begin(), content.attributes.end(), [&](const std::string& name) {
           const Attribute* attribute = shape.find(name);
           return attribute && attribute->per_point() && attribute->components == 1 &&
                  attribute->count() == shape.size();
         });
}

std::vector<std::byte> patched_solid(const Shape& shape, const SolidContent& content, char comment) {
  std::vector<const Attribute*> attributes;
  for (const std::string& name : content.attributes) attributes.push_back(shape.find(name));
  TextPatch patch(content.bytes);
  TextCursor cursor("", as_text(content.bytes));
  for (std::size_t i = 0; i < shape.size(); ++i) {
    cursor.seek(content.points[i]);
    for (int c = 0; c < 3; ++c)
      patch.set(cursor.next(comment), shape.positions[i][c], shape.position_type, shape.origin[c]);
    for (const Attribute* attribute : attributes) {
      const Token t = cursor.next(comment);
      std::int64_t was = 0;
      if (!is_integer(attribute->type))
        patch.set(t, attribute->number(i, 0), attribute->type);
      else if (!parse(t.text, was) || static_cast<double>(was) != attribute->number(i, 0))
        patch.replace(t, value_text(attribute->type, attribute->values.data() + i * attribute->row_size()));
    }
  }
  return patch.finish();
}

void report_lost_rest(const std::string& format, WriteReport& report) {
  report.lost.push_back("What the " + format +
                        " file held besides points, faces and tets is not written: they are no longer those of the "
                        "file.");
}

const Attribute* label_of(const Shape& shape) {
  const Attribute* label = shape.find("label");
  if (!label || !label->per_point() || label->components != 1 || !is_integer(label->type)) return nullptr;
  for (std::size_t i = 0; i < label->count(); ++i)
    if (std::abs(label->number(i, 0)) > std::numeric_limits<std::int32_t>::max()) return nullptr;
  return label;
}

void append_point(std::vector<std::byte>& out, const Shape& shape, std::size_t i) {
  for (int c = 0; c < 3; ++c) {
    if (c > 0) append_text(out, " ");
    append_number(out, shape.positions[i][c] + shape.origin[c], shape.position_type);
  }
}

void append_corners(std::vector<std::byte>& out, std::span<const Index> corners, Index first) {
  for (const Index p : corners) append_text(out, " " + std::to_string(std::uint64_t{p} + first));
}

Faces small_faces(const std::string& format, const Shape& shape, std::size_t most, WriteReport& report) {
  Faces out;
  std::size_t cut = 0;
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    const auto face = shape.faces[f];
    if (face.size() <= most) {
      out.add(face);
      continue;
    }
    ++cut;
    for (std::size_t c = 2; c < face.size(); ++c) out.add(std::array{face[0], face[c - 1], face[c]});
  }
  if (cut > 0)
    report.lost.push_back(format + " cannot hold " + counted(cut, "face", "faces") + " of more than " +
                          std::to_string(most) + " corners: cut into triangles.");
  return out;
}

}  // namespace sinew::io
