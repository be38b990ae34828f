#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(push_constant, scalar) uniform Constants { OverlayConstants c; };
#include "overlay.glsl"
layout(location = 0) in vec4 color;
layout(location = 1) noperspective in float across;
layout(location = 2) flat in vec2 style;
layout(location = 0) out vec4 out_color;

void main() {
  const float cover = clamp(0.5 * style.x + 0.5 - abs(across), 0.0, 1.0);
  out_color = vec4(color.rgb, color.a * cover * seen(gl_FragCoord.z, style.y));
}
