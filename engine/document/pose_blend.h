#pragma once
/// A pose between two: where a solve begins between two keys.

#include "engine/geometry/deformer.h"

namespace sinew::document {

/// A pose and the structure at the rest that it belongs to.
struct PosedStructure {
  const Deformer::Structure& structure;
  const Pose& pose;
};

/// The pose at the rest of `now` whose maps are the share 1 - u of `first` and u of `second`: each map's linear part by
/// slerp of its rotation and linearly in its stretch, its displacement of the structure's vertex that follows it
/// linearly. The three structures have the same vertices and maps. A map that no vertex follows stays as in `first`.
Pose blended(const PosedStructure& first, const PosedStructure& second, double u, const Deformer::Structure& now);

}  // namespace sinew::document
