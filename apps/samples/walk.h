#pragma once
/// A mesh animation: a foal that walks on the spot along +x, one closed mesh whose vertices move. Metres, y up, the
/// ground at y = 0.
///
/// The skin is the zero set of an Implicit at rest. Each vertex has weights over rigid bones: first the bone of the
/// part of the surface that it lies on, then evened out along the mesh, so that what is near but not joined (a leg
/// beside a leg) stays apart. A frame is p' = sum_b w_b (R_b (p - rest_b) + joint_b). A leg is posed from its foot's
/// path: the two bones above the fetlock meet where the circles of their lengths do.

#include "apps/samples/streams.h"
#include "engine/geometry/shape.h"

namespace sinew::samples {

constexpr int walk_cycle = 24;  ///< frames of a stride

/// The foal at rest: about 8,400 vertices, as the horse of Sumner, Schmid and Pauly, Figure 8, has.
Shape foal();

/// Frames 1 to `frames` of the walk at 24 frames a second; frame f + walk_cycle is frame f again. All have the vertices
/// and faces of foal().
void make_walk(int frames, const TakeFrame& take);

}  // namespace sinew::samples
