#pragma once
/// The embedded deformation graph [Sumner, Schmid, Pauly: Embedded Deformation for Shape Manipulation, SIGGRAPH 2007]
/// as a Deformer: bends anything that is points in space.
///
/// The final answer is the minimum of the paper's energy (graph_energy.h), 12 unknowns a node. While dragging, and on
/// the way there, the R_j are kept exact rotations: 6 unknowns a node, a factor a quarter in size, and a result within
/// 0.4 % of the diagonal. What differs from the paper: solving happens with the bounding-box diagonal at 1 (the paper
/// names no length); a component of the graph without a handle or a fixed point rests.

#include <memory>

#include "engine/geometry/deformer.h"

namespace sinew {

struct GraphOptions {
  int nodes = 250;        ///< wanted count
  int neighbours = 4;     ///< k of eq. 4
  bool surface = false;   ///< influence by distance along the surface (graph_influence.h) instead of straight
  bool simplify = false;  ///< nodes by simplification of the faces instead of by sampling
  std::uint64_t seed = 0;
  double w_rot = 1, w_reg = 10, w_con = 100;
  bool plain = false;        ///< the paper's Gauss-Newton from the start, a new factor each iteration: the reference
  std::vector<Index> given;  ///< points of the shape to be the nodes; empty: chosen
  std::vector<Cut> cuts;     ///< no influence passes through these
  int adapt = 0;             ///< most nodes that refined() grows the graph to; 0: it stays as it is
  bool chain = false;        ///< edges join each of `given` to the next and no others [section 5, particle simulations]
};

/// Throws InputError where the shape has no finite point or a given node is not one. Null where progress said false.
std::unique_ptr<Deformer> make_graph_deformer(std::shared_ptr<const Shape> rest, const GraphOptions& options,
                                              const std::function<bool(double)>& progress = {});

/// The row of the methods table.
Method graph_method();

}  // namespace sinew
