#pragma once
/// A closed surface with fewer vertices.

#include <functional>

#include "deformers/tet_surface.h"

namespace sinew {

/// Decimated to about `count` vertices, all of them vertices of `surface`, in their order. It may cross itself, and
/// where parts of the surface came to share an edge, not be one of two triangles an edge: see is_closed. Stops early
/// where go_on says false.
TetSurface decimated_surface(const TetSurface& surface, std::size_t count, const std::function<bool()>& go_on);

}  // namespace sinew
