#pragma once
/// Methods whose final answer depends on the edit alone: a solve of Quality::Final begins at Layer::start, or at rest,
/// wherever the drag before it had got to. So the window ends where the command line, undo and the saved file do.

#include <span>
#include <vector>

#include "engine/geometry/deformer.h"

namespace sinew::editor {

/// The same methods, with such deformers. `methods` must outlive what is returned.
std::vector<Method> repeatable(std::span<const Method> methods);

}  // namespace sinew::editor
