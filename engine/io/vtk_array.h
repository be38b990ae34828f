#pragma once
/// Arrays of points as VTK's files have them, legacy and XML: as text, as bytes, as base64. What the readers and
/// writers of both share.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/shape.h"
#include "engine/io/io.h"
#include "engine/io/point_names.h"
#include "engine/io/text.h"

namespace sinew::io {

struct VtkArray {
  enum class Form { Text, Bytes, Base64 };

  std::string name;  ///< of the shape's attribute
  Type type = Type::Float32;
  std::size_t components = 1, rows = 0;
  Form form = Form::Text;
  bool swap = false;               ///< bytes and base64: the byte order is not this machine's
  std::size_t begin = 0, end = 0;  ///< bytes of the file: the text, the values or the base64
  std::size_t header = 0;          ///< base64: bytes in front of the values (their length)

  std::size_t count() const { return rows * components; }
  std::size_t size() const { return count() * size_of(type); }
};

/// What is kept of a file of either format.
struct VtkContent : FileContent {
  enum class Form { Legacy, PolyData, UnstructuredGrid };
  Form form = Form::Legacy;  ///< the last two: XML
  std::vector<std::byte> bytes;
  VtkArray points;
  std::vector<VtkArray> attributes;
  std::size_t faces = 0, corners = 0, tets = 0;  ///< of the shape
};

/// Throws InputError where `rows` of `components` cannot lie within `left` bytes of the file as the array's form has
/// them.
void check_vtk_size(const std::string& path, std::size_t at, const VtkArray& array, std::size_t left,
                    const std::string& what);

/// The values of an array of text at the cursor, in this machine's byte order; the cursor is behind them afterwards.
std::vector<std::byte> vtk_text_values(TextCursor& cursor, const VtkArray& array, const std::string& what);
/// The values of an array of bytes or base64, in this machine's byte order.
std::vector<std::byte> vtk_binary_values(const std::string& path, std::span<const std::byte> bytes,
                                         const VtkArray& array, const std::string& what);
/// The first `size` bytes that the base64 in [begin, end) of a file holds; `end` is behind them afterwards. Throws
/// InputError where it holds fewer.
std::vector<std::byte> decode_base64(const std::string& path, std::span<const std::byte> bytes, std::size_t begin,
                                     std::size_t& end, std::size_t size, const std::string& what);

/// The shape's positions from values of `type`, and its position_type.
void set_vtk_points(Shape& shape, Type type, std::span<const std::byte> values);

/// Adds an attribute, and its array to the content.
void add_vtk_attribute(Shape& shape, VtkContent& content, VtkArray array, Attribute attribute,
                       std::vector<std::byte> values);

/// VTK's numbers of the types of cells that are read and written.
enum VtkCell : std::int64_t { vtk_vertex = 1, vtk_triangle = 5, vtk_polygon = 7, vtk_quad = 9, vtk_tetra = 10 };
inline bool is_vtk_face(std::int64_t type) {
  return type == vtk_triangle || type == vtk_polygon || type == vtk_quad;
}
/// What is wrong with these corners of a tet; empty where nothing is, and then it was added.
std::string add_vtk_tet(Shape& shape, std::span<const Index> corners);
/// Completes the content from the shape that was read, and gives it to the shape. `others`: cells that are not of it;
/// `arrays`: those that are not the points'.
void keep_vtk(Shape& shape, std::shared_ptr<VtkContent> content, std::size_t others, std::size_t arrays);

/// Whether the file can take the shape's points and attributes in place of those read.
bool fits_vtk(const Shape& shape, const VtkContent& content, VtkContent::Form form);
/// The file with those values replaced that have changed.
std::vector<std::byte> patched_vtk(const Shape& shape, const VtkContent& content, WriteReport& report);

/// The attributes of a new file, each with a value a point; packed colours become three bytes. Says what is lost.
std::vector<Attribute> new_vtk_attributes(const Shape& shape, const std::string& format, WriteReport& report);
/// The positions of a new file in position_type and this machine's byte order; says what rounding takes away.
std::vector<std::byte> new_vtk_points(const Shape& shape, WriteReport& report);

}  // namespace sinew::io
