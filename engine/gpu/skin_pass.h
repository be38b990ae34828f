#pragma once
/// Skinning of device points: skin.comp, and the same on the CPU in float. Both compute, with q = p - centre,
///   q' = q + sum_j w_ij ((A_j - I) q + (A_j - I) centre + t_j),
/// which is skin_points() of geometry in the points' own coordinates.

#include "engine/gpu/points.h"

namespace sinew::gpu {

/// Writes the pose into points.maps: per map [A - I | (A - I) centre + t], 4 columns of 3 floats.
void write_maps(const Device& device, Points& points, const Pose& pose);

/// Records skin.comp into `commands`, with the barriers around it: its results may be read as vertices or copied.
void record_skin(const Device& device, VkCommandBuffer commands, const Points& points);

/// The same, at once, for points whose buffers are mapped.
void skin_on_cpu(Points& points);

}  // namespace sinew::gpu
