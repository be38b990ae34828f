#version 460

layout(location = 0) flat in uint id;
layout(location = 0) out uint out_id;

void main() {
  const vec2 from_middle = gl_PointCoord - 0.5;
  if (dot(from_middle, from_middle) > 0.25) discard;
  out_id = id;
}
