#pragma once
/// The sample animal as Gaussian splats: flat discs on its skin, as training on photographs would leave them.

#include <cstdint>

#include "engine/geometry/shape.h"

namespace sinew::samples {

/// `count` discs, strewn evenly over the surface, each with the attributes of a file of 3D Gaussian splatting, in its
/// order: normal (zeros, as in those files), f_dc, f_rest (bands 1 to 3, channel after channel), opacity (before the
/// logistic function), scale (logarithms of standard deviations, metres; the third across the skin), rot (w, x, y, z).
/// The colour is that of the coat in daylight; its bands 1 to 3 are a sheen: the reflection of a sun, seen only from
/// the side where it leads. The same for the same arguments on any number of threads.
Shape sample_splats(std::size_t count, std::uint64_t seed = 1);

}  // namespace sinew::samples
