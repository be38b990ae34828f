#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(push_constant, scalar) uniform Constants { DrawConstants c; };
layout(location = 0) in vec4 color;
layout(location = 0) out vec4 out_color;

// Of four samples, where Vulkan's standard puts them.
const vec2 samples[4] = vec2[](vec2(-0.125, -0.375), vec2(0.375, -0.125), vec2(-0.375, 0.125), vec2(0.125, 0.375));

void main() {
  const vec2 from_middle = (gl_PointCoord - 0.5) * c.size;  // pixels
  const float squared = 0.25 * c.size * c.size;
  int covered = 0;
  if ((c.flags & draw_smooth) != 0u) {
    for (int k = 0; k < 4; ++k) {
      const vec2 at = from_middle + samples[k];
      if (dot(at, at) <= squared) covered |= 1 << k;
    }
  } else if (c.size <= square_size || dot(from_middle, from_middle) <= squared) {
    covered = 1;
  }
  if (covered == 0) discard;
  gl_SampleMask[0] = covered;
  out_color = color;
}
