#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(push_constant, scalar) uniform Constants { ComposeConstants c; };
layout(location = 0) out vec4 out_color;

// A dither of half a step hides the bands of a dark gradient.
float dither(vec2 at) {
  return fract(52.9829189 * fract(dot(at, vec2(0.06711056, 0.00583715)))) - 0.5;
}

void main() {
  const vec4 color = mix(unpackUnorm4x8(c.top), unpackUnorm4x8(c.bottom), gl_FragCoord.y / c.size.y);
  out_color = vec4(color.rgb + dither(gl_FragCoord.xy) / 255.0, 0);
}
