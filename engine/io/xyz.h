#pragma once
/// XYZ, ASC, TXT, PTS, CSV: a point cloud as rows of three or more numbers, separated by blanks, tabs, commas or
/// semicolons, also in quotes.
///
/// Read: rows of equal length; blank lines; comments (#, //, ;) on lines of their own, the first two also behind a row;
/// before the first row a line of column names, as a comment or not, and a line with the count of rows.
///
/// Meaning of the columns, with names (in any order and case, as many as columns; blanks within them where commas,
/// semicolons or tabs stand between them): x y z (also points:0 ...) the position; nx ny nz (also normal_x ...)
/// attribute "normal"; r g b [a], red green blue [alpha] or rf gf bf attribute "color"; vx vy vz (also velocity_x ...,
/// velocity:0 ...) attribute "velocity"; label, class, classification and id an id; every other a scalar of its name.
/// Without names: the first three are the position; of the others, the first three neighbours that are unit vectors (to
/// 1e-3; a row of zeros or NaN has none) are "normal", the first three (of seven columns the last three) that are whole
/// numbers of 0 to 255 are "color", the fourth of four, or of seven with a colour in the last three, is "intensity";
/// every other a scalar "column 5".
///
/// Types: a colour of whole numbers of 0 to 255 is UInt8; all else is Float32 where that loses nothing (text_patch.h),
/// otherwise Float64.
///
/// Written: for a shape that was read from such a file and has as many points and the same attributes, the bytes of its
/// file with those numbers replaced that have changed. For any other shape rows "x y z", then the attributes with a
/// value for each point, and a first line of names ("//X Y Z R G B Nx Ny Nz intensity") where there are any; in CSV
/// always one of names ("x,y,z,id"), and commas.
///
/// Refused (InputError): no row, a row of fewer than three or more than 256 numbers or of another length than the rows
/// above, a field that is no number, a count that is not the number of rows, a name line without x, y
/// and z, and one that is no comment and has more or fewer names than there are columns.

#include "engine/io/io.h"

namespace sinew::io {

Shape read_xyz(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
std::vector<std::byte> write_xyz(const std::string& path, const Shape& shape, WriteReport& report);

Shape read_csv(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
std::vector<std::byte> write_csv(const std::string& path, const Shape& shape, WriteReport& report);

}  // namespace sinew::io
