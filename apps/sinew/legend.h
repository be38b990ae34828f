#pragma once
/// Legend: what the colours of a field stand for, drawn into the corner of a finished picture.

#include "apps/sinew/field.h"
#include "engine/gpu/offscreen.h"

namespace sinew::app {

/// Name, colours and the numbers at their ends, at the bottom left. Nothing where the picture has no room for it.
void draw_legend(gpu::Picture& picture, const Field& field);

}  // namespace sinew::app
