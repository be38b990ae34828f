#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(push_constant, scalar) uniform Constants { DrawConstants c; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in uvec4 color;
layout(location = 0) out vec4 out_color;
#include "surface.glsl"

void main() {
  gl_Position = c.clip * vec4(position, 1);
  gl_PointSize = c.size;
  if ((color.a & mark_hidden) != 0u || isnan(gl_Position.x)) gl_Position = vec4(0, 0, -1, 0);
  float light = unlit;
  if ((c.flags & draw_normals) != 0u) {
    const vec3 eye = to_eye(position);
    light = light_on(dot(normal, eye) < 0.0 ? -normal : normal, eye);
  }
  out_color = vec4(mark_tint(vec3(color.rgb) / 255.0, color.a) * light, (color.a & mark_selected) != 0u ? 1.0 : 0.0);
  if ((c.flags & draw_ghost) != 0u) out_color = unpackUnorm4x8(c.ghost_color);
}
