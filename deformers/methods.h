#pragma once
/// The methods that Sinew has, one row each; the applications hand them to document.

#include <span>

#include "engine/geometry/deformer.h"

namespace sinew {

std::span<const Method> methods();

}  // namespace sinew
