#include <algorithm>
#include <bit>
#include <limits>

#include "engine/io/text_patch.h"
#include "engine/io/values.h"
#include "engine/io/vtk.h"
#include "engine/io/vtk_array.h"

namespace sinew::io {

namespace {

constexpr bool swap_big = std::endian::native != std::endian::big;

bool is_keyword(std::string name) {
  for (char& c : name)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return name == "METADATA" || name == "NULL_ARRAY";
}

/// Special characters of names as %20.
std::string encoded(const std::string& name) {
  static constexpr char hex[] = "0123456789ABCDEF";
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    // Words that mean something else where a name is expected get such a character too.
    if (byte > ' ' && byte < 127 && c != '%' && c != '"' && !(out.empty() && is_keyword(name))) {
      out += c;
    } else {
      out += {'%', hex[byte >> 4], hex[byte & 15]};
    }
  }
  return out.empty() ? "unnamed" : out;
}

const char* vtk_name(Type type) {
  static constexpr const char* names[] = {"char",         "unsigned_char", "short",         "unsigned_short", "int",
                                          "unsigned_int", "vtktypeint64",  "vtktypeuint64", "float",          "double"};
  return names[static_cast<int>(type)];
}

void append_values(std::vector<std::byte>& out, Type type, std::span<const std::byte> values) {
  const std::size_t size = size_of(type), begin = out.size();
  out.insert(out.end(), values.begin(), values.end());
  if (swap_big)
    for (std::size_t i = begin; i < out.size(); i += size)
      std::reverse(out.begin() + static_cast<std::ptrdiff_t>(i), out.begin() + static_cast<std::ptrdiff_t>(i + size));
  append_text(out, "\n");
}

void append_int(std::vector<std::byte>& out, std::size_t x) {
  std::byte bytes[4];
  store(bytes, static_cast<std::int32_t>(x), swap_big);
  out.insert(out.end(), bytes, bytes + sizeof(bytes));
}

void append_cell(std::vector<std::byte>& out, std::span<const Index> corners) {
  append_int(out, corners.size());
  for (const Index p : corners) append_int(out, p);
}

/// The polygons, or a vertex for each point where there are none; with tets, both as the cells of a grid.
void append_cells(std::vector<std::byte>& out, const Shape& shape) {
  const std::size_t n = shape.size(), faces = shape.faces.size(), tets = shape.tets.size();
  const auto begin = [&out](const char* keyword, std::size_t cells, std::size_t corners) {
    append_text(out, std::string(keyword) + " " + std::to_string(cells) + " " + std::to_string(cells + corners) + "\n");
  };
  if (tets > 0) {
    begin("CELLS", faces + tets, shape.faces.points.size() + 4 * tets);
  } else if (faces > 0) {
    begin("POLYGONS", faces, shape.faces.points.size());
  } else {
    begin("VERTICES", n, n);
    for (Index i = 0; i < n; ++i) append_cell(out, {&i, 1});
  }
  for (std::size_t f = 0; f < faces; ++f) append_cell(out, shape.faces[f]);
  for (const Tet& tet : shape.tets) append_cell(out, tet);
  append_text(out, "\n");
  if (tets == 0) return;
  append_text(out, "CELL_TYPES " + std::to_string(faces + tets) + "\n");
  for (std::size_t i = 0; i < faces + tets; ++i) append_int(out, i < faces ? vtk_polygon : vtk_tetra);
  append_text(out, "\n");
}

std::vector<std::byte> new_vtk(const std::string& path, const Shape& shape, WriteReport& report) {
  const std::size_t n = shape.size();
  const std::size_t numbers = shape.faces.size() + shape.faces.points.size() + 5 * shape.tets.size();
  const std::size_t most = std::numeric_limits<std::int32_t>::max();
  if (n > most / 2 || numbers > most) throw file_error(path, "a VTK file of less than 2^31 numbers of cells", "more");
  std::vector<std::byte> out;
  append_text(out, std::string("# vtk DataFile Version 3.0\npoints\nBINARY\nDATASET ") +
                       (shape.tets.empty() ? "POLYDATA" : "UNSTRUCTURED_GRID") + "\nPOINTS " + std::to_string(n) + " " +
                       vtk_name(shape.position_type) + "\n");
  append_values(out, shape.position_type, new_vtk_points(shape, report));
  append_cells(out, shape);
  const std::vector<Attribute> attributes = new_vtk_attributes(shape, "VTK", report);
  if (attributes.empty()) return out;
  append_text(out, "POINT_DATA " + std::to_string(n) + "\nFIELD FieldData " + std::to_string(attributes.size()) + "\n");
  for (const Attribute& a : attributes) {
    append_text(out, encoded(a.name) + " " + std::to_string(a.components) + " " + std::to_string(n) + " " +
                         vtk_name(a.type) + "\n");
    append_values(out, a.type, a.values);
  }
  return out;
}

}  // namespace

std::vector<std::byte> write_vtk(const std::string& path, const Shape& shape, WriteReport& report) {
  const auto* content = dynamic_cast<const VtkContent*>(shape.content.get());
  if (content && fits_vtk(shape, *content, VtkContent::Form::Legacy)) return patched_vtk(shape, *content, report);
  if (content && content->form == VtkContent::Form::Legacy)
    report.lost.push_back(
        "What the VTK file held besides points, data of points, polygons and tets is not written: the "
        "points, attributes, faces or tets are no longer those of the file.");
  return new_vtk(path, shape, report);
}

}  // namespace sinew::io
