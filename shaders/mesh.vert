#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(push_constant, scalar) uniform Constants { DrawConstants c; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in uvec4 color;
layout(location = 0) out vec3 out_position;
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec4 out_color;
layout(location = 3) out float out_hidden;
#include "surface.glsl"

void main() {
  const bool lost = any(isnan(position)) || any(isinf(position));
  out_hidden = lost || (color.a & mark_hidden) != 0u ? 1.0 : 0.0;
  out_position = lost ? vec3(0) : position;
  gl_Position = c.clip * vec4(out_position, 1);
  out_normal = normal;
  out_color = vec4(mark_tint(vec3(color.rgb) / 255.0, color.a), (color.a & mark_selected) != 0u ? 1.0 : 0.0);
}
