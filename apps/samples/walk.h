#pragma once
/// A mesh animation: a foal (foal.h) that walks on the spot along +x. A leg is posed from its foot's path.

#include "apps/samples/foal.h"
#include "apps/samples/streams.h"
#include "engine/geometry/shape.h"

namespace sinew::samples {

constexpr int walk_cycle = 24;  ///< frames of a stride

/// Frames 1 to `frames` of the walk at 24 frames a second; frame f + walk_cycle is frame f again. All have the vertices
/// and faces of foal().
void make_walk(int frames, const TakeFrame& take);

}  // namespace sinew::samples
