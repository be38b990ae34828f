#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

// A Gaussian splat in its box: 4 corners an instance.

layout(push_constant, scalar) uniform Constants { SplatConstants c; };
layout(location = 0) in vec3 at;
layout(location = 1) in vec3 conic;
layout(location = 2) in vec2 reach;
layout(location = 3) in vec4 color;
layout(location = 0) noperspective out vec2 out_from_middle;  // pixels
layout(location = 1) flat out vec3 out_conic;
layout(location = 2) flat out vec4 out_color;

void main() {
  out_from_middle = vec2((gl_VertexIndex & 1) * 2 - 1, (gl_VertexIndex & 2) - 1) * reach;
  gl_Position = vec4((at.xy + out_from_middle) * 2.0 / c.size - 1.0, at.z, 1);
  out_conic = conic;
  out_color = color;
}
