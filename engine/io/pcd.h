#pragma once
/// PCD 0.5 to 0.7 (Point Cloud Library), a point cloud in text or binary: DATA ascii, binary, binary_compressed.
///
/// Read: fields of any SIZE, TYPE and COUNT. x, y and z are the position; normal_x normal_y normal_z attribute
/// "normal"; rgb or rgba attribute "color", one component of the file's type (its bits are the colour, also where they
/// are a NaN); r g b [a] attribute "color"; label and others that end in "label" or "id" an id; every other field a
/// scalar of COUNT components. Fields named "_" are padding: they stay in the file. Organised clouds (HEIGHT above 1)
/// keep their order and their points that are NaN. position_type is Float32 or Float64 as the type of x, y and z.
///
/// Written: for a shape that was read from PCD and has as many points and the same attributes, its file with those
/// values replaced that have changed: header, VIEWPOINT, comments, padding and unchanged text stay; compressed data is
/// packed anew only where a value changed. For any other shape a binary PCD 0.7 of its position and attributes.
/// A file of floats rounds moved points to floats; WriteReport::lost says so where that is more than half a millimetre
/// of a metre.
///
/// Refused (InputError): a header without FIELDS, DATA or the fields x, y and z, counts that contradict each other or
/// cannot fit into the file, damaged compressed data, rows of another length than the fields, numbers that are none or
/// out of the range of their type.

#include "engine/io/io.h"

namespace sinew::io {

Shape read_pcd(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
std::vector<std::byte> write_pcd(const std::string& path, const Shape& shape, WriteReport& report);

}  // namespace sinew::io
