#include "engine/io/ply.h"

#include <array>
#include <cmath>

#include "engine/io/ply_content.h"
#include "engine/io/ply_values.h"
#include "engine/io/text_patch.h"

namespace sinew::io {

namespace {

constexpr std::size_t chunk_rows = 1 << 16;

struct Reader {
  const std::string& path;
  const ReadOptions& options;
  PlyContent& content;
  Shape& shape;
  std::size_t short_faces = 0;  ///< with fewer than three corners

  const std::vector<std::byte>& bytes() const { return content.bytes; }
  std::size_t point_count() const { return content.header.vertices().count; }
};

/// Rows of the points, packed, chunk by chunk.
template <class Values>
void read_points(Reader& reader, Values& values, const PlyElement& element) {
  const std::size_t stride = reader.content.layout.stride;
  std::vector<std::byte> packed;
  PlyVertices layout = reader.content.layout;
  layout.swap = false;
  for (std::uint64_t row = 0; row < element.count; row += chunk_rows) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(chunk_rows, element.count - row));
    packed.resize(count * stride);
    for (std::size_t i = 0; i < count; ++i) {
      values.begin_row(row + i);
      read_packed(values, element, packed.data() + i * stride, [](std::size_t, std::size_t, std::size_t) {});
      values.end_row();
    }
    append_rows(layout, packed, reader.shape);
    report_progress(reader.options, values.at(), reader.bytes().size());
  }
}

/// Rows of fixed size straight from the file.
void read_fixed_points(Reader& reader, std::size_t at) {
  const PlyVertices& layout = reader.content.layout;
  const std::size_t n = reader.point_count();
  reader.shape.positions.reserve(n);
  for (Attribute& attribute : reader.shape.attributes) attribute.values.reserve(n * attribute.row_size());
  const std::span<const std::byte> rows(reader.bytes().data() + at, n * layout.stride);
  for (std::size_t first = 0; first < n; first += chunk_rows) {
    const std::size_t count = std::min(chunk_rows, n - first);
    append_rows(layout, rows.subspan(first * layout.stride, count * layout.stride), reader.shape);
    report_progress(reader.options, at + (first + count) * layout.stride, reader.bytes().size());
  }
}

template <class Values>
Index read_corner(Reader& reader, Values& values, Type type) {
  const std::int64_t corner = values.integer(type);
  if (corner < 0 || static_cast<std::uint64_t>(corner) >= reader.point_count())
    throw values.error("in " + values.place().name() + " a point below " + std::to_string(reader.point_count()),
                       std::to_string(corner));
  return static_cast<Index>(corner);
}

template <class Values>
void read_polygon(Reader& reader, Values& values, const PlyProperty& property) {
  const std::uint64_t n = list_length(values, property);
  Faces& faces = reader.shape.faces;
  const std::size_t before = faces.points.size();
  for (std::uint64_t i = 0; i < n; ++i) faces.points.push_back(read_corner(reader, values, property.type));
  if (faces.points.size() > 0xfffffffe) throw values.error("at most 4294967294 corners of faces", "more");
  if (n >= 3) {
    faces.offsets.push_back(static_cast<Index>(faces.points.size()));
  } else {
    faces.points.resize(before);
    ++reader.short_faces;
  }
}

/// Corner i >= 2 of a strip makes a triangle with the two before it, every other one turned over; -1 begins anew.
template <class Values>
void read_strip(Reader& reader, Values& values, const PlyProperty& property) {
  const std::uint64_t n = list_length(values, property);
  std::array<Index, 2> last{};
  std::uint64_t length = 0;
  for (std::uint64_t i = 0; i < n; ++i) {
    const std::int64_t corner = values.integer(property.type);
    if (corner == -1) {
      length = 0;
      continue;
    }
    if (corner < -1 || corner >= static_cast<std::int64_t>(reader.point_count()))
      throw values.error("in " + values.place().name() + " -1 or a point below " + std::to_string(reader.point_count()),
                         std::to_string(corner));
    const auto c = static_cast<Index>(corner);
    const auto [a, b] = last;
    if (length >= 2 && a != b && b != c && c != a)
      reader.shape.faces.add(length % 2 == 0 ? std::array{a, b, c} : std::array{b, a, c});
    last = {b, c};
    ++length;
  }
}

/// The list of an element that holds corners, or null.
const PlyProperty* corners_of(const PlyElement& element) {
  if (element.name != "face" && element.name != "tristrips") return nullptr;
  for (const PlyProperty& property : element.properties)
    if (property.list && (property.name == "vertex_indices" || property.name == "vertex_index")) return &property;
  return nullptr;
}

/// Rows of any element but the points; makes faces of those that are faces.
template <class Values>
void read_rows(Reader& reader, Values& values, const PlyElement& element) {
  if (element.properties.empty()) return;
  const PlyProperty* corners = corners_of(element);
  const bool strips = element.name == "tristrips";
  for (std::uint64_t row = 0; row < element.count; ++row) {
    values.begin_row(row);
    for (const PlyProperty& property : element.properties) {
      values.set_property(property);
      if (&property == corners) {
        strips ? read_strip(reader, values, property) : read_polygon(reader, values, property);
      } else {
        values.skip(property.type, property.list ? list_length(values, property) : 1);
      }
    }
    values.end_row();
    if (row % chunk_rows == chunk_rows - 1) report_progress(reader.options, values.at(), reader.bytes().size());
  }
}

void read_binary(Reader& reader) {
  const PlyHeader& header = reader.content.header;
  PlyBinary values(reader.path, reader.bytes(), header.size, header.swap());
  for (const PlyElement& element : header.elements) {
    values.begin_element(element);
    if (element.name == "vertex") {
      reader.content.vertices_at = values.at();
      if (element.has_list()) {
        read_points(reader, values, element);
      } else {
        read_fixed_points(reader, values.at());
        values.skip_rows(element.count, reader.content.layout.stride);
      }
    } else {
      read_rows(reader, values, element);
    }
  }
  if (const std::size_t left = reader.bytes().size() - values.at(); left > 0)
    reader.shape.notes.push_back(std::to_string(left) + " bytes after the last element are kept but not read.");
}

void read_ascii(Reader& reader) {
  const PlyHeader& header = reader.content.header;
  const std::string_view text = as_text(reader.bytes());
  PlyText values(reader.path, text, header.size, header.lines + 1);
  for (const PlyElement& element : header.elements) {
    values.begin_element(element);
    if (element.name == "vertex") {
      reader.content.vertices_at = values.at();
      reader.content.vertices_line = values.line();
      read_points(reader, values, element);
    } else {
      read_rows(reader, values, element);
    }
  }
  const std::size_t next = text.find_first_not_of(" \t\v\f\r\n", values.at());
  if (next != std::string_view::npos)
    reader.shape.notes.push_back(std::to_string(text.size() - next) +
                                 " bytes after the last element are kept but not read.");
}

/// Positions of an ascii file that are declared float are read as doubles first: text may hold more. Where a float
/// would lose more than it can have been written from (float_limit), they stay doubles.
void widen(PlyHeader& header) {
  if (header.encoding != PlyEncoding::Ascii) return;
  PlyElement& vertices = header.elements[header.vertex];
  const auto is_position = [](const PlyProperty& p) { return p.name == "x" || p.name == "y" || p.name == "z"; };
  for (const PlyProperty& p : vertices.properties)
    if (is_position(p) && p.type != Type::Float32) return;
  for (PlyProperty& p : vertices.properties)
    if (is_position(p)) p.type = Type::Float64;
  header.widened = true;
}

void narrow(Reader& reader) {
  if (!reader.content.header.widened) return;
  constexpr double loss = 1e-5;
  const auto as_float = [](double x) { return as_read(x, Type::Float32); };
  for (const Vec3& p : reader.shape.positions)
    for (int c = 0; c < 3; ++c)
      if (std::abs(p[c]) >= float_limit && std::abs(p[c] - as_float(p[c])) > loss) {
        reader.shape.notes.push_back(
            "The coordinates are declared float but have more digits: they are kept as double.");
        return;
      }
  reader.content.layout.narrow = true;
  reader.content.layout.position_type = Type::Float32;
  reader.shape.position_type = Type::Float32;
  for (Vec3& p : reader.shape.positions) p = p.unaryExpr(as_float);
}

void add_notes(Reader& reader) {
  for (const PlyProperty& property : reader.content.header.vertices().properties)
    if (property.list)
      reader.shape.notes.push_back("The list \"" + property.name + "\" of the points is kept but not used.");
  for (const PlyElement& element : reader.content.header.elements)
    if (element.name == "face" && element.count > 0 && corners_of(element) == nullptr)
      reader.shape.notes.push_back("The faces have no list of vertex_indices: they are kept but not used.");
  if (reader.short_faces > 0)
    reader.shape.notes.push_back(std::to_string(reader.short_faces) +
                                 " faces of fewer than 3 corners are kept but not used.");
}

}  // namespace

std::uint64_t fingerprint(const Faces& faces) {
  std::uint64_t h = faces.size();
  const auto add = [&h](std::uint64_t x) { h = (h ^ x) * 0x9e3779b97f4a7c15U ^ (h >> 29); };
  for (const Index offset : faces.offsets) add(offset);
  for (const Index point : faces.points) add(point);
  return h;
}

Shape read_ply(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options) {
  auto content = std::make_shared<PlyContent>();
  content->bytes = std::move(bytes);
  content->header = parse_ply_header(path, as_text(content->bytes));
  constexpr std::uint64_t most = 0xfffffffe;
  if (content->header.vertices().count > most)
    throw text_error(path, content->header.lines, 0, "at most 4294967294 points",
                     std::to_string(content->header.vertices().count));
  widen(content->header);
  content->layout = layout_of(content->header);
  Shape shape;
  shape.attributes = content->layout.attributes;
  shape.position_type = content->layout.position_type;
  Reader reader{path, options, *content, shape};
  content->header.encoding == PlyEncoding::Ascii ? read_ascii(reader) : read_binary(reader);
  narrow(reader);
  add_notes(reader);
  content->faces = fingerprint(shape.faces);
  shape.content = std::move(content);
  return shape;
}

}  // namespace sinew::io
