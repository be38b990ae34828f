#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(push_constant, scalar) uniform Constants { DrawConstants c; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 color;
layout(location = 3) in float hidden;
layout(location = 0) out vec4 out_color;
#include "surface.glsl"

void main() {
  if (hidden > 0.0) discard;  // a corner is hidden or has no place
  const vec3 eye = to_eye(position);
  vec3 n = normalize(cross(dFdx(position), dFdy(position)));
  if (dot(n, eye) < 0.0) n = -n;
  // Both sides are lit: the smooth normal is turned to the side that the face shows.
  if ((c.flags & draw_flat) == 0u && dot(normal, normal) > 0.0)
    n = dot(normal, n) < 0.0 ? -normalize(normal) : normalize(normal);
  if ((c.flags & draw_ghost) != 0u) {
    const float rim = 1.0 - abs(dot(n, eye));
    out_color = unpackUnorm4x8(c.ghost_color) * vec4(1, 1, 1, 0.25 + 0.75 * rim * rim);
    return;
  }
  out_color = vec4(color.rgb * light_on(n, eye), color.a > 0.5 ? 1.0 : 0.0);
}
