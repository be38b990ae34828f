#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

// Eye-dome lighting, and an outline around what is selected.

layout(push_constant, scalar) uniform Constants { ComposeConstants c; };
layout(set = 0, binding = 0) uniform sampler2D colors;
layout(set = 0, binding = 1) uniform sampler2D depths;
layout(location = 0) out vec4 out_color;

ivec2 last;

float depth(ivec2 at) {
  return texelFetch(depths, clamp(at, ivec2(0), last), 0).r;
}

void main() {
  last = ivec2(c.size) - 1;
  const ivec2 at = ivec2(gl_FragCoord.xy);
  const vec4 own = texelFetch(colors, at, 0);
  const float z = depth(at);
  float shade = 1.0;
  if (c.edl_strength > 0.0 && z > 0.0) {
    const float scale = c.linear_depth > 0.0 ? c.linear_depth : inverse_ln2 / z;
    const int r = int(c.edl_radius), d = max(1, int(0.7 * c.edl_radius + 0.5));
    const ivec2 ring[edl_taps] = ivec2[](ivec2(r, 0), ivec2(-r, 0), ivec2(0, r), ivec2(0, -r), ivec2(d, d),
                                         ivec2(-d, d), ivec2(d, -d), ivec2(-d, -d));
    float sum = 0.0;
    for (int k = 0; k < edl_taps; ++k) sum += clamp((depth(at + ring[k]) - z) * scale, 0.0, edl_limit);
    shade = edl_shade(c.edl_strength * sum);
  }
  out_color = vec4(own.rgb * shade, 1);
  if (c.outline != 0u && own.a < 0.5) {
    float near = 0.0;
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        near = max(near, texelFetch(colors, clamp(at + ivec2(x, y), ivec2(0), last), 0).a);
    out_color.rgb = mix(out_color.rgb, unpackUnorm4x8(c.outline).rgb, near);
  }
}
