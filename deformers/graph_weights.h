#pragma once
/// Influence of the nodes on points, and the edges that follow from it [Sumner et al. 2007, section 3, eq. 4].

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "engine/geometry/curtains.h"
#include "engine/geometry/nearest.h"
#include "engine/geometry/skin_weights.h"

namespace sinew {

/// w_j(v) = (1 - |v - g_j| / d_max)^2 over the k nearest nodes, divided by their sum; d_max is the distance to the
/// (k+1)-th. Where all k + 1 are equally far (the formula gives 0/0), the k share equally. With k nodes or fewer, k is
/// one less than their number (one node: weight 1). A point that is not finite has an empty row. Rows list nodes in
/// order of distance; weights of zero are left out. Gradients are those of the formula; at a node, where
/// |v - g_j| has none, that distance is taken as constant. `progress` (0..1) may return false: the result is then
/// empty.
///
/// A node behind a curtain has no influence: the k + 1 nearest are then those that are not. A point that is cut off
/// from every node follows the nearest one; `cut_off`, if given, counts those points.
SkinWeights node_weights(const NearestTree& nodes, int k, std::span<const Eigen::Vector3d> points, Gradients gradients,
                         const std::function<bool(double)>& progress = {}, const Curtains& curtains = {},
                         std::size_t* cut_off = nullptr);

/// Eq. 4 for one point with its k + 1 nearest nodes' distances (ascending); writes k weights that sum to one.
void weights_of(const double* distance, int k, double* w);

/// An edge (low, high), ascending, between any two nodes that influence one common point.
std::vector<std::pair<std::uint32_t, std::uint32_t>> influence_edges(const SkinWeights& weights, std::size_t nodes);

}  // namespace sinew
