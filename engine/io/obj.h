#pragma once
/// OBJ (Wavefront), polygons in text.
///
/// Read: `v x y z`, also with a weight w (kept in the file) or with a colour `r g b [a]` behind (attribute "color");
/// `vn` (attribute "normal": vn i belongs to the points of the corners that use it, or to point i where there are no
/// faces and as many vn as v); `f` with v, v/vt, v//vn and v/vt/vn, any number of corners, negative indices and indices
/// of points that follow later; comments, continued lines, '\n', "\r\n" and '\r', a UTF-8 byte order mark.
/// Texture coordinates, materials, groups, lines, points, faces of fewer than three corners and unknown keywords stay
/// in the file; Shape::notes counts them. position_type is Float32 where that loses nothing (text_patch.h), otherwise
/// Float64; normals and colours likewise.
///
/// Written: for a shape that was read from OBJ and has as many points, normals, colours and faces, the bytes of its
/// file with those numbers of `v` and `vn` replaced that have changed, as the shortest text of the double or the float.
/// For any other shape v (with colour), vn and f; a normal of several points is shared.
///
/// Refused (InputError): no v line, a number that is none, an index that is none, is 0 or has no point.

#include "engine/io/io.h"

namespace sinew::io {

Shape read_obj(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
std::vector<std::byte> write_obj(const std::string& path, const Shape& shape, WriteReport& report);

}  // namespace sinew::io
