#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(push_constant, scalar) uniform Constants { OverlayConstants c; };
#include "overlay.glsl"
layout(location = 0) in vec2 at;
layout(location = 1) flat in vec4 color;
layout(location = 2) flat in vec4 outline;
layout(location = 3) flat in vec3 style;
layout(location = 0) out vec4 out_color;

void main() {
  const float radius = length(at);
  const float inner = clamp(style.x + 0.5 - radius, 0.0, 1.0);
  const float outer = clamp(style.x + style.y + 0.5 - radius, 0.0, 1.0);
  const float alpha = mix(outline.a * outer, color.a, inner);
  out_color = vec4(mix(outline.rgb, color.rgb, inner), alpha * seen(gl_FragCoord.z, style.z));
}
