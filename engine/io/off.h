#pragma once
/// OFF (Geomview), polygons in text: OFF, and with a prefix of ST, C, N for texture coordinates, colours and normals of
/// the points.
///
/// Read: the keyword (it may be missing), counts of points, faces and edges, points as numbers however the lines are
/// broken, faces as a count and as many indices from 0; what follows on the line of a face (its colour) and all other
/// text stays in the file and is counted in Shape::notes, as are faces of fewer than three corners and texture
/// coordinates. `#` comments to the end of a line. Normals become "normal". Colours of points, three or four numbers by
/// the length of the first point's line, become "color": UInt8 where all are whole numbers of 0 to 255 and one is above
/// 1, otherwise fractions. position_type is Float32 where that loses nothing (text_patch.h), otherwise Float64.
///
/// Written: for a shape that was read from OFF and has as many points, normals, colours and faces, the bytes of its
/// file with those of their numbers replaced that have changed. For any other shape a new file with what OFF can hold.
///
/// Refused (InputError): binary files, 4OFF, nOFF, counts that cannot fit into the file, numbers that are none, indices
/// without a point, a file that ends early.

#include "engine/io/io.h"

namespace sinew::io {

Shape read_off(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
std::vector<std::byte> write_off(const std::string& path, const Shape& shape, WriteReport& report);

}  // namespace sinew::io
