#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(push_constant, scalar) uniform Constants { GroundConstants c; };
layout(location = 0) out vec2 out_at;

void main() {
  out_at = vec2((gl_VertexIndex & 1) * 2 - 1, (gl_VertexIndex & 2) - 1) * c.radius;
  gl_Position = c.clip * vec4(out_at, 0, 1);
}
