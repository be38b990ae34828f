#pragma once
/// A PLY to stream, and a bending of it that a block of points cannot tell from the whole.

#include <cmath>
#include <string>

#include "engine/geometry/shape.h"
#include "tests/io/ply_maker.h"

namespace sinew::io {

/// Moves every third point and halves every fifth normal, by the coordinates alone: the same however it is cut.
inline void bend(Shape& block) {
  Attribute* normal = block.find("normal");
  for (std::size_t i = 0; i < block.size(); ++i) {
    const double x = block.positions[i].x() + block.origin.x();
    if (std::fmod(x, 3) == 0) block.positions[i] += Vec3(0.25, -0.5, 0.125);
    if (normal != nullptr && std::fmod(x, 5) == 0) normal->set_number(i, 1, 0.5);
  }
}

/// n points of 32 bytes with normals between their coordinates; an element before them and faces behind.
inline MadePly made_ply(const std::string& encoding, std::size_t n) {
  MadeElement vertex{"vertex",
                     {scalars("double", "x", {}), scalars("float", "nx", {}), scalars("float", "ny", {}),
                      scalars("float", "nz", {}), scalars("double", "y", {}), scalars("float", "z", {})}};
  for (std::size_t i = 0; i < n; ++i) {
    const auto x = static_cast<double>(i);
    std::size_t p = 0;
    for (const double value : {5400000 + x, 0.6, 0.0, 0.8, -x, 1e-3 * x})
      vertex.properties[p++].values.push_back({value});
  }
  const MadeElement first{"first", {scalars("int", "a", {1, 2, 3})}};
  const MadeElement faces{"face", {{"list uchar int", "vertex_indices", {{0, 1, 0}}}}};
  return {encoding, "\n", {"comment c"}, {first, vertex, faces}};
}

}  // namespace sinew::io
