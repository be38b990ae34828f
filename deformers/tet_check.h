#pragma once
/// What sinew-tets answered, checked against the surface it was given.

#include <string>
#include <vector>

#include "deformers/tet_mesh.h"
#include "deformers/tet_process.h"
#include "deformers/tet_surface.h"

namespace sinew {

/// The tets that the surface winds around, as they were answered; what was added in cavities is left out. Each has a
/// positive volume, and the volumes add up to the surface's: a region's as often as the surface winds around it.
/// `wrong` gets what is not so ("tet 3 of volume -0.1 around (0, 1, 0)"), and then the mesh means nothing. `notes` gets
/// a sentence where triangles of the surface are no sides of tets, because vertices were added on them.
TetMesh checked_tets(const Shape& shape, const TetSurface& surface, const TetAnswer& answer, std::string& wrong,
                     std::vector<std::string>& notes);

}  // namespace sinew
