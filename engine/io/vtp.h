#pragma once
/// VTK XML (.vtp PolyData, .vtu UnstructuredGrid), one piece, not compressed: points with data.
///
/// Read: arrays as ascii, as base64 within their element, and appended, raw or base64, of either byte order and with
/// lengths of 32 or 64 bits. Points, PointData, and as faces the polygons of PolyData or the triangles, quadrilaterals
/// and polygons of an UnstructuredGrid, and its tets. Vectors, Normals, GlobalIds and PedigreeIds of PointData name
/// arrays of these kinds; other names have their meaning by point_names.h. All else stays in the file; Shape::notes
/// counts other cells and arrays of cells and of the whole. position_type is as of the legacy format (vtk.h).
///
/// Written: for a shape that was read from such a file and has as many points, faces and tets and the same attributes,
/// its file with those values replaced that have changed, in place for all forms but ascii. The attributes RangeMin and
/// RangeMax of arrays, hints that readers compute anew, stay as they were. For any other shape a new file with raw
/// appended data, little-endian: points, PointData, polygons, tets of a grid, or a vertex for each point where there
/// are no cells.
///
/// Refused (InputError): compressed data, several pieces, arrays that overlap, counts that contradict each other or do
/// not fit into the file, a tet with a point twice, text that is no XML of the simple kind (xml_scanner.h).

#include "engine/io/io.h"

namespace sinew::io {

Shape read_vtp(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
std::vector<std::byte> write_vtp(const std::string& path, const Shape& shape, WriteReport& report);
/// The same as an UnstructuredGrid.
std::vector<std::byte> write_vtu(const std::string& path, const Shape& shape, WriteReport& report);

}  // namespace sinew::io
