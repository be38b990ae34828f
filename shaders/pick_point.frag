#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(push_constant, scalar) uniform Constants { DrawConstants c; };
layout(location = 0) flat in uint id;
layout(location = 0) out uint out_id;

void main() {
  const vec2 from_middle = gl_PointCoord - 0.5;
  if (c.size > square_size && dot(from_middle, from_middle) > 0.25) discard;
  out_id = id;
}
