#pragma once
/// Gmsh .msh in text, versions 2 ($Nodes, $Elements) and 1 ($NOD, $ELM): points, faces and tets.
///
/// Read: points by their numbers, which need not be consecutive, and of the elements the triangles and quadrilaterals
/// as faces and the tets; of those of higher order the corners. All other elements and sections ($PhysicalNames,
/// $NodeData
/// ...) and the tags of elements stay in the file; Shape::notes counts and names them. position_type is Float32 where
/// that loses nothing (text_patch.h), otherwise Float64.
///
/// Written: for a shape that was read from such a file and has as many points, faces and tets, the bytes of its file
/// with those coordinates replaced that have changed. For any other shape a new file of version 2.2: points, faces (of
/// more than four corners as triangles), tets.
///
/// Refused (InputError): version 4 and later and the binary form, counts that cannot fit into the file, numbers that
/// are none, two points of one number, elements of numbers without a point or of another count of points than their
/// type has, a tet with a point twice, a file that ends early.

#include "engine/io/io.h"

namespace sinew::io {

Shape read_gmsh(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
std::vector<std::byte> write_gmsh(const std::string& path, const Shape& shape, WriteReport& report);

}  // namespace sinew::io
