#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

// A line as a quad of its width and a soft pixel on each side: 4 corners an instance.

layout(push_constant, scalar) uniform Constants { OverlayConstants c; };
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in vec4 color;
layout(location = 3) in vec2 style;  // width in pixels, part that is seen through what stands before it
layout(location = 0) out vec4 out_color;
layout(location = 1) noperspective out float out_across;  // pixels from the middle
layout(location = 2) flat out vec2 out_style;

void main() {
  vec4 a = c.clip * vec4(from, 1), b = c.clip * vec4(to, 1);
  const float nearest = 1e-6;
  const float low = min(a.w, b.w);
  if (low < nearest) {  // the part before the eye
    const vec4 cut = mix(a, b, clamp((nearest - a.w) / (b.w - a.w), 0.0, 1.0));
    if (a.w < nearest) a = cut;
    if (b.w < nearest) b = cut;
  }
  const vec2 along = (b.xy / b.w - a.xy / a.w) * c.size;
  const float length2 = dot(along, along);
  const vec2 side = length2 > 0.0 ? vec2(-along.y, along.x) * inversesqrt(length2) : vec2(0, 1);
  const float half_width = 0.5 * style.x + 1.0;
  const float sign = (gl_VertexIndex & 1) == 0 ? -1.0 : 1.0;
  const vec4 end = (gl_VertexIndex & 2) == 0 ? a : b;
  gl_Position = vec4(end.xy + side * sign * half_width * 2.0 / c.size * end.w, end.z, end.w);
  out_across = sign * half_width;
  out_color = color;
  out_style = style;
}
