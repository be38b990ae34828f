#pragma once
/// VTK legacy (.vtk), ascii and binary (big-endian), versions 1 to 5: points with data.
///
/// Read: the points of POLYDATA and UNSTRUCTURED_GRID, the polygons of POLYDATA as faces, the triangles,
/// quadrilaterals and polygons of an UNSTRUCTURED_GRID as faces and its tets, and of POINT_DATA the arrays
/// of SCALARS, COLOR_SCALARS, VECTORS, NORMALS, TEXTURE_COORDINATES, TENSORS, GLOBAL_IDS, PEDIGREE_IDS and FIELD.
/// VECTORS are of kind Vector, NORMALS of kind Normal, and names have their meaning by point_names.h (an array
/// "velocity" of three is a velocity, whatever it is declared as). All else stays in the file; Shape::notes counts
/// cells other than vertices, polygons and tets, data of cells and of the whole, texts and bits. position_type is
/// Float32 for float and integers up to 16 bits, otherwise Float64.
///
/// Written: for a shape that was read from such a file and has as many points, faces and tets and the same attributes,
/// its file with those values replaced that have changed. For any other shape a binary POLYDATA of version 3.0: points,
/// a vertex for each where there are no faces (viewers show vertices), polygons, all attributes as a FIELD; with tets
/// an UNSTRUCTURED_GRID of the polygons and the tets.
///
/// Refused (InputError): other datasets, counts that contradict each other or do not fit into the file, numbers that
/// are none, a tet with a point twice, unknown keywords and types.

#include "engine/io/io.h"

namespace sinew::io {

Shape read_vtk(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
std::vector<std::byte> write_vtk(const std::string& path, const Shape& shape, WriteReport& report);

}  // namespace sinew::io
