#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(push_constant, scalar) uniform Constants { DrawConstants c; };
layout(location = 0) in vec3 position;
layout(location = 2) in uvec4 color;
layout(location = 0) out float out_hidden;

void main() {
  const bool lost = any(isnan(position)) || any(isinf(position));
  out_hidden = lost || (color.a & mark_hidden) != 0u ? 1.0 : 0.0;
  gl_Position = c.clip * vec4(lost ? vec3(0) : position, 1);
}
