#pragma once
/// Gaps between the parts of a shape that do not touch, and the edges that bridge them: what joins a chair's legs to
/// its seat, and does not join a hand to the leg that it lies on.

#include <span>

#include "engine/geometry/curtains.h"
#include "engine/geometry/neighbour_graph.h"

namespace sinew {

struct BridgeWishes {
  double touch = 0;               ///< any two parts are joined wherever they are as near as this
  double reach = 0;               ///< see bridges_between
  double spacing = 0;             ///< of the points, an edge's length
  std::span<const Index> weight;  ///< of each part; a set of parts that weighs less than `enough` has to be joined
  Index enough = 0;
};

/// Edges between points of different parts; never between two of one part, so nothing is shortened within a part.
///
/// 1. Points of different parts within `touch` of each other (seams but for rounding) are joined.
/// 2. Then, in rounds, each set of parts joined so far takes its shortest gap to any other, and is joined there if the
///    gap is at most `reach` or the set weighs less than `enough` [Boruvka's minimum spanning tree, stopped at
///    `reach`]. So each part is joined to its nearest and, through that, to the rest.
/// 3. Where two parts were joined across a gap g, each point of the smaller that is within 2 g + `spacing` of the other
///    part is joined to its nearest point there: a cushion lies on its seat and does not hang from one corner.
///
/// No edge crosses a curtain. Equal gaps: lowest points first. The result does not depend on threads.
Edges bridges_between(std::span<const Vec3> points, const GraphParts& parts, const BridgeWishes& wishes,
                      const Curtains& curtains);

}  // namespace sinew
