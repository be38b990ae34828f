#pragma once
/// The header of a PLY file: encoding, elements and their properties, and where the data begin.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/geometry/attribute.h"

namespace sinew::io {

struct PlyProperty {
  std::string name;
  Type type = Type::Float32;
  bool list = false;
  Type count_type = Type::UInt8;  ///< of a list: an integer type
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  bool has_list() const;
  /// Bytes of one row of a binary file; where it has lists, the smallest possible.
  std::size_t row_size() const;
};

enum class PlyEncoding { Ascii, Little, Big };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::Ascii;
  std::vector<PlyElement> elements;
  std::size_t vertex = 0;    ///< which element is "vertex"
  std::size_t size = 0;      ///< bytes, including the end of the line of end_header
  std::int64_t lines = 0;    ///< of the header
  std::size_t comments = 0;  ///< lines of comment and obj_info

  bool widened = false;  ///< x, y, z are said to be Float64 here but are text that is declared float

  const PlyElement& vertices() const { return elements[vertex]; }
  bool swap() const;  ///< binary data are not in this machine's byte order
};

/// Parses the header at the beginning of `text`, which may go on. Throws InputError, also where there is no vertex
/// element or it lacks x, y or z. Counts are only known to be from 0 to 2^63.
PlyHeader parse_ply_header(const std::string& path, std::string_view text);

/// "float" ... of the PLY format for the types it has; null for 64-bit integers.
const char* ply_name_of(Type type);

}  // namespace sinew::io
