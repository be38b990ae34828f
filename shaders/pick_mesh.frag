#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(push_constant, scalar) uniform Constants { DrawConstants c; };
layout(location = 0) in float hidden;
layout(location = 0) out uint out_id;

void main() {
  if (hidden > 0.0) discard;
  out_id = c.first_id + uint(gl_PrimitiveID);
}
