#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(push_constant, scalar) uniform Constants { DrawConstants c; };
layout(location = 0) in vec3 position;
layout(location = 2) in uvec4 color;
layout(location = 0) flat out uint out_id;

void main() {
  gl_Position = c.clip * vec4(position, 1);
  gl_PointSize = c.size;
  if ((color.a & mark_hidden) != 0u || isnan(gl_Position.x)) gl_Position = vec4(0, 0, -1, 0);
  out_id = c.first_id + uint(gl_VertexIndex);
}
