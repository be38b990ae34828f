#pragma once
/// A polygon soup as modellers make them: a chair of 16 parts that are not joined, some of them of polygons that share
/// no vertex, with 12- and 24-gons, edges of three faces, groups, materials and texture coordinates. Metres, y up,
/// facing +x, standing on y = 0.

#include <string>

namespace sinew::samples {

/// The text of an OBJ file that names this file of materials.
std::string chair(const std::string& material_file);

/// The text of that file.
std::string chair_materials();

}  // namespace sinew::samples
