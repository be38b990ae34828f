#pragma once
/// Numbers as colours.

#include "engine/gpu/points.h"

namespace sinew::gpu {

/// 0..1 to dark violet ... yellow (viridis, van der Walt and Smith 2015, from nine of its colours).
PointColor viridis(double x);

}  // namespace sinew::gpu
