#pragma once
/// TetGen's files: NAME.node has the points, NAME.ele the tets, NAME.face, if there is one, the faces.
///
/// Read: either of NAME.node and NAME.ele finds the other and NAME.face beside it; a .node alone is a point cloud, an
/// .ele alone is refused. `#` comments. Points are numbered in order from 0 or 1, by the first; cells have the same
/// numbers. Attributes of points become "attribute 1", "attribute 2" ..., their boundary marker, a whole number,
/// becomes "label". Of tets of ten points the first four are read. Regions of tets and markers of faces stay in their
/// files. position_type is Float32 where that loses nothing (text_patch.h), otherwise Float64.
///
/// Written: all that belongs together, under the new name. For a shape that was read from such files and has as many
/// points, faces and tets, their bytes, with those numbers of the .node replaced that have changed. For any other shape
/// new files, counted from 1: attributes with a value a point as TetGen's, without their names, and faces as triangles.
///
/// Refused (InputError): two dimensions, counts that cannot fit into the file, numbers that are none, points out of
/// order, indices without a point, a tet with a point twice, files that end early.

#include <optional>

#include "engine/io/io.h"

namespace sinew::io {

/// What belongs together; the paths are for messages.
struct TetgenFiles {
  NamedBytes node;
  std::optional<NamedBytes> ele, face;
};
Shape read_tetgen(TetgenFiles files, const ReadOptions& options);

Shape read_node(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
Shape read_ele(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
/// The bytes of the .node, or of the .ele.
std::vector<std::byte> write_node(const std::string& path, const Shape& shape, WriteReport& report);
std::vector<std::byte> write_ele(const std::string& path, const Shape& shape, WriteReport& report);
/// The other files of the shape, named beside `path`.
std::vector<NamedBytes> beside_node(const std::string& path, const Shape& shape);
std::vector<NamedBytes> beside_ele(const std::string& path, const Shape& shape);

}  // namespace sinew::io
