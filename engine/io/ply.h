#pragma once
/// PLY, the polygon file format of Stanford: ascii and binary of both byte orders, any scalar type, lists anywhere, any
/// elements before and after the points. Faces are `face` lists (vertex_indices or vertex_index) and `tristrips`.
///
/// Fields of the points become attributes: nx ny nz a normal, red green blue [alpha] a colour, vx vy vz a vector, the
/// fields of Gaussian splats their quaternion, log-scales and spherical harmonics, others a scalar or id each.
/// All else (comments, other elements, lists of points, properties of faces) is kept by the bytes of the file.

#include <cstddef>
#include <string>
#include <vector>

#include "engine/io/io.h"

namespace sinew::io {

Shape read_ply(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);

/// Where the shape came from a PLY of as many points and the same attributes: that file, with the values replaced that
/// differ from it. Otherwise a new binary_little_endian file.
std::vector<std::byte> write_ply(const std::string& path, const Shape& shape, WriteReport& report);

}  // namespace sinew::io
