#pragma once
/// The sample animal: a giraffe about 2 m high, standing on y = 0, looking along +x. Metres.

#include "apps/samples/implicit.h"

namespace sinew::samples {

/// Its skin. Material of a part: see Material.
const Implicit& animal();

enum class Material { Coat, Pale, Dark, Black };

/// How much light the skin gives back at p, in [0, 1]: brown patches between pale lines (cells of a jittered grid),
/// pale lower legs and muzzle, some black spots that a scanner does not see.
double reflectance(const Vec3& p, int material);

/// The colour of skin that gives back this much light: from black over brown to cream, each 0 to 255.
Vec3 skin_color(double light);

}  // namespace sinew::samples
