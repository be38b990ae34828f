#pragma once
/// STL, ascii and binary: a soup of triangles. Each facet has three points of its own (nothing is joined), and the
/// attribute "normal" has a value a facet (attribute.h: points).
///
/// A file is binary where its size is 84 + 50 x its count of facets, whatever the header says ("solid" too). Header,
/// names of solids and the attribute bytes of facets are kept by the bytes of the file.

#include <cstddef>
#include <string>
#include <vector>

#include "engine/io/io.h"

namespace sinew::io {

/// Ascii numbers become Float32 where that loses nothing (text_patch.h), otherwise Float64.
Shape read_stl(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);

/// Where the shape came from an STL of as many facets: that file, with the numbers replaced that differ. Otherwise a
/// new binary file; polygons are cut into fans. Throws InputError where the shape has no faces.
std::vector<std::byte> write_stl(const std::string& path, const Shape& shape, WriteReport& report);

}  // namespace sinew::io
