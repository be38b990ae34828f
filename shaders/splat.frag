#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(set = 0, binding = 1) uniform sampler2D depths;
layout(location = 0) noperspective in vec2 from_middle;
layout(location = 1) flat in vec3 conic;
layout(location = 2) flat in vec4 color;
layout(location = 0) out vec4 out_color;

void main() {
  if (texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r > gl_FragCoord.z) discard;
  const vec2 d = from_middle;
  const float squared = conic.x * d.x * d.x + 2.0 * conic.y * d.x * d.y + conic.z * d.y * d.y;
  const float alpha = color.a * exp(-0.5 * squared);
  if (squared > splat_cut || alpha < splat_least) discard;
  out_color = vec4(color.rgb * alpha, alpha);
}
