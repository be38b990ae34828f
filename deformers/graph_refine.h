#pragma once
/// Where a deformation graph is too coarse for an edit, and the nodes to add there: the dynamic update of the graph
/// that [Sumner et al. 2007, section 6] leaves open.
///
/// Neighbouring maps of spacing h disagree by about kappa h^2 where the shape bends by kappa, so a node's share of eq.
/// 7 is w_reg kappa^2 h^4: the squared stretch (kappa h)^2 that blending them leaves in the shape, times the area h^2
/// of the node. A sum of shares is therefore comparable between graphs of different density, and the fewest nodes are
/// those whose shares are equal. Nodes are added around those that hold most of the whole [marked after Doerfler: A
/// convergent adaptive algorithm for Poisson's equation, SIAM J. Numer. Anal. 1996], at twice the density: a steeper
/// grading costs more stretch where coarse meets fine than it saves.

#include <span>
#include <utility>
#include <vector>

#include "engine/geometry/shape.h"
#include "engine/geometry/skin_weights.h"

namespace sinew {

/// The fewest nodes that together hold 3/10 of the energy, but at least every 20th node that has any (one, if fewer),
/// so that a graph doubles in few rounds even where one point holds it all. Largest first, equal ones by index.
std::vector<Index> marked_nodes(std::span<const double> energy);

/// Which of the candidates become nodes, at most `most`, for the marked nodes in their order. A candidate lies in the
/// cell of the node that it follows most (`weights` of the candidates); those farthest from every node are added until
/// all of a cell are within 0.7 of its radius of one. Distances are to the node of the cell, its neighbours in the
/// graph and what was added in their cells, so that nodes which the influence keeps apart do not count.
std::vector<Index> candidates_to_add(std::span<const Vec3> candidates, const SkinWeights& weights,
                                     std::span<const Vec3> nodes, std::span<const std::pair<Index, Index>> edges,
                                     std::span<const Index> marked, std::size_t most);

}  // namespace sinew
