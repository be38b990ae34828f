#pragma once
/// The CPU twin of shaders/skin.comp: moves points, and with them every attribute, by its kind.

#include <memory>
#include <span>

#include "engine/geometry/shape.h"
#include "engine/geometry/skin_weights.h"

namespace sinew {

/// out[i] = in[i] + sum_j w_ij ((A_j - I) in[i] + t_j). in, out: n; out may be in. Threads do not change a bit.
void skin_points(const SkinWeights& weights, const Pose& pose, std::span<const Vec3> in, std::span<Vec3> out);

/// The blended matrices M_i = I + sum_j w_ij (A_j - I) of points [first, first + out.size()).
void blend_matrices(const SkinWeights& weights, const Pose& pose, std::size_t first, std::span<Mat3> out);

/// A normal under p -> M p: cofactor(M) n, scaled back to the length of n [Sumner et al. 2007, eq. 3: inverse
/// transpose]. Where M is singular along n, n itself.
Vec3 skin_normal(const Mat3& M, const Vec3& n);

/// `rest` bent: positions and every attribute whose kind bends (skin_attributes.h); faces, other attributes and the
/// file's content are those of rest. A value whose points all have identity maps keeps its bits.
/// rate: d(map)/dt, a second, one for each map of the pose; null where the maps do not change with time. Only
/// velocities ask for it. weights.size() == rest.size().
Shape skin(const Shape& rest, const SkinWeights& weights, const Pose& pose, const Pose* rate = nullptr);

/// Whether an attribute bends by the derivative of the map by position: then skin() is exact only where the weights
/// come from bind(points, Gradients::Yes).
bool needs_gradients(const Shape& shape);

/// What skin() leaves as it is although its kind bends, one sentence each.
std::vector<std::string> not_bent(const Shape& shape);

}  // namespace sinew
