#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

// A disc with an outline: 4 corners an instance.

layout(push_constant, scalar) uniform Constants { OverlayConstants c; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 color;
layout(location = 2) in vec4 outline;
layout(location = 3) in vec3 style;  // radius, width of the outline around it, part seen through what stands before it
layout(location = 0) out vec2 out_at;  // pixels from the middle
layout(location = 1) flat out vec4 out_color;
layout(location = 2) flat out vec4 out_outline;
layout(location = 3) flat out vec3 out_style;

void main() {
  const vec4 middle = c.clip * vec4(position, 1);
  const vec2 corner = vec2((gl_VertexIndex & 1) * 2 - 1, (gl_VertexIndex & 2) - 1);
  out_at = corner * (style.x + style.y + 1.0);
  gl_Position = middle.w > 0.0 ? vec4(middle.xy + out_at * 2.0 / c.size * middle.w, middle.zw) : vec4(0, 0, -1, 0);
  out_color = color;
  out_outline = outline;
  out_style = style;
}
