#pragma once
/// What the freely named arrays of particle files (bgeo, VTK) mean: kind and name of the attribute that each becomes.

#include <string>
#include <vector>

#include "engine/geometry/attribute.h"
#include "engine/io/text_patch.h"

namespace sinew::io {

/// An attribute without type and values. By name, in any case: v, vel, velocity, velocities of three are "velocity";
/// n, normal, normals of three "normal"; Cd, color, colors, colour, rgb, rgba of three or four "color"; id, ids and
/// names that end in a word of these ("particleId", "point_ids") are an id. All else keeps its name and is of kind
/// `otherwise`. Fields are the usual ones ("vx", "nx", "red") or NAME_0, NAME_1; a name that was used already gets a
/// number (UniqueNames).
Attribute named_attribute(const std::string& name, int components, Kind otherwise, UniqueNames& unique);

}  // namespace sinew::io
