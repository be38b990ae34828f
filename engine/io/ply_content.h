#pragma once
/// What is kept of a PLY file so that it can be written again with other values.

#include <cstddef>
#include <vector>

#include "engine/geometry/shape.h"
#include "engine/io/ply_vertices.h"

namespace sinew::io {

struct PlyContent : FileContent {
  std::vector<std::byte> bytes;  ///< all of the file
  PlyHeader header;
  PlyVertices layout;
  std::size_t vertices_at = 0;     ///< byte where the first point begins
  std::int64_t vertices_line = 0;  ///< and its line, of an ascii file
  std::uint64_t faces = 0;         ///< fingerprint of the faces as they were read
};

/// Tells faces apart, so that a writer sees when they are no longer those of the file.
std::uint64_t fingerprint(const Faces& faces);

}  // namespace sinew::io
