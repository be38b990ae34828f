#pragma once
/// Classic bgeo (Houdini to version 11, and most simulators): "BgeoV" version 5, big-endian points with attributes.
///
/// Read: the points and their attributes of the types float and vector (Float32), int and index (Int32). Position is
/// x, y, z (Float32); its weight stays in the file. Names have their meaning by point_names.h: v is a velocity, N a
/// normal, Cd a colour, id an id; another vector of three but "rest" is of kind Vector, an index (a number that stands
/// for a text) an Id, all else Scalar. Closed polygons become faces as far as nothing but polygons and particle systems
/// comes before them. All else stays in the file (texts of an index, other primitives, attributes of vertices,
/// primitives and the whole, groups); Shape::notes counts what a reader may miss.
///
/// Written: for a shape that was read from bgeo and has as many points and faces and the same attributes, its file with
/// those values replaced that have changed. For any other shape a new file of floats and ints: points, attributes,
/// closed polygons. Fractions of colours take the place of bytes, an alpha is an attribute of its own.
/// WriteReport::lost names what does not fit: doubles that are rounded, integers beyond 32 bits.
///
/// Refused (InputError): the JSON geometry of later Houdini versions, compressed files (.bgeo.gz), ascii .geo, another
/// version than 5, counts and lengths that do not fit into the file, unknown types of attributes.

#include "engine/io/io.h"

namespace sinew::io {

Shape read_bgeo(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
std::vector<std::byte> write_bgeo(const std::string& path, const Shape& shape, WriteReport& report);

}  // namespace sinew::io
