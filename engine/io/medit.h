#pragma once
/// Medit .mesh (INRIA; fTetWild, TetWild, gmsh, Mmg), in text: points, faces and tets.
///
/// Read: MeshVersionFormatted, Dimension 3, Vertices, Triangles and Quadrilaterals (as faces), Tetrahedra, in any order
/// but for the points, which come first; `#` comments. Indices count from 1. The references of the points, where one is
/// not 0, become "label". All other sections (Edges, Corners, RequiredVertices, Normals ...) and the references of
/// faces and tets stay in the file and are named in Shape::notes; so is what follows End, which may be missing. A
/// section of another keyword ends at the next word that is no number. position_type is Float32 where that loses
/// nothing (text_patch.h), otherwise Float64.
///
/// Written: for a shape that was read from such a file and has as many points, faces and tets, the bytes of its file
/// with those of its numbers replaced that have changed. For any other shape a new file: points with their "label",
/// faces (of more than four corners as triangles), tets.
///
/// Refused (InputError): the binary form (.meshb), two dimensions, counts that cannot fit into the file, numbers that
/// are none, indices without a point, a tet with a point twice, a file that ends early.

#include "engine/io/io.h"

namespace sinew::io {

Shape read_medit(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
std::vector<std::byte> write_medit(const std::string& path, const Shape& shape, WriteReport& report);

}  // namespace sinew::io
