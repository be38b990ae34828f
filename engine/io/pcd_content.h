#pragma once
/// What reader and writer of PCD share: the header, the layout of values, and what is kept of a file.

#include <bit>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew::io {

static_assert(std::endian::native == std::endian::little, "PCD is little-endian and values are copied as they are");

struct PcdField {
  std::string name;
  Type type = Type::Float32;
  std::size_t count = 1;   ///< values a point
  std::size_t offset = 0;  ///< bytes of the fields before it, of one point

  std::size_t size() const { return count * size_of(type); }
};

struct PcdHeader {
  enum class Data { Ascii, Binary, Compressed };

  std::vector<PcdField> fields;
  std::size_t points = 0;
  Data data = Data::Ascii;
  std::size_t point_size = 0;  ///< bytes
  std::size_t values = 0;      ///< of a point
  std::size_t begin = 0;       ///< byte of the file where the data begins
  std::int64_t line = 1;       ///< of the first data

  /// Byte of the values of field f of point i. Compressed data holds all of a field, then all of the next.
  std::size_t at(std::size_t f, std::size_t i) const {
    const PcdField& field = fields[f];
    return data == Data::Compressed ? points * field.offset + i * field.size() : i * point_size + field.offset;
  }
};

/// Fields that are one attribute; its components are their values one after another. The first group is the position.
struct PcdGroup {
  std::string name;
  Kind kind = Kind::Scalar;
  std::vector<std::size_t> fields;
};

struct PcdContent : FileContent {
  std::vector<std::byte> bytes;
  PcdHeader header;
  std::vector<PcdGroup> groups;
};

/// Throws InputError with the place of what is wrong; believes no count that does not fit into the file.
PcdHeader parse_pcd_header(const std::string& path, std::span<const std::byte> bytes);

/// The values of all points, `points` x `point_size` bytes laid out as PcdHeader::at: parsed (ascii, laid out as
/// binary) or unpacked or copied.
std::vector<std::byte> pcd_values(const std::string& path, std::span<const std::byte> bytes, const PcdHeader& header);

}  // namespace sinew::io
