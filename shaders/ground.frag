#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

// Lines a pixel wide at every cell, stronger at every tenth, fading with the distance and where they get too close.

layout(push_constant, scalar) uniform Constants { GroundConstants c; };
layout(set = 0, binding = 1) uniform sampler2D depths;
layout(location = 0) in vec2 at;
layout(location = 0) out vec4 out_color;

float lines(vec2 cells, vec2 pixel) {
  const vec2 from_line = abs(fract(cells - 0.5) - 0.5) / pixel;  // in pixels
  const vec2 cover = clamp(1.0 - from_line, 0.0, 1.0) * clamp(1.4 - 3.0 * pixel, 0.0, 1.0);
  return max(cover.x, cover.y);
}

void main() {
  if (texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r > gl_FragCoord.z) discard;
  const vec2 cells = at + c.origin, pixel = fwidth(at);
  const float fade = clamp(1.0 - dot(at, at) / (c.radius * c.radius), 0.0, 1.0);
  const float strength = max(0.65 * lines(cells, pixel), lines(0.1 * cells, 0.1 * pixel));
  const vec4 color = unpackUnorm4x8(c.color);
  out_color = vec4(color.rgb, color.a * fade * fade * strength);
}
