#pragma once
/// What the reader and the writer of bgeo share: numbers of the format, and what is kept of a file.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew::io {

/// bgeo is big-endian.
inline constexpr bool bgeo_swap = std::endian::native != std::endian::big;
inline constexpr std::uint32_t bgeo_version = 5, bgeo_polygon = 1, bgeo_particles = 0x8000, bgeo_run = 0xffffffff;
inline constexpr std::size_t bgeo_header = 41;  ///< bytes
/// Primitives refer to points by two bytes up to here, by four above.
inline constexpr std::size_t bgeo_short_points = 65536;

/// The types of attributes; a value has four bytes in each.
enum class BgeoType : std::uint32_t { Float = 0, Int = 1, Index = 4, Vector = 5 };

/// A point is x, y, z, w and then the values of all attributes one after another.
struct BgeoContent : FileContent {
  struct Column {
    std::string name;  ///< of the shape's attribute
    Type type = Type::Float32;
    int components = 1;
    std::size_t offset = 0;  ///< bytes from where the point begins
  };

  std::vector<std::byte> bytes;
  std::vector<Column> columns;
  std::size_t begin = 0, stride = 16, points = 0;  ///< byte of the first point, bytes of a point
  std::size_t faces = 0, corners = 0;              ///< of the shape
};

}  // namespace sinew::io
