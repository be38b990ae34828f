// Colour of a surface under the light; see surface_light in shared.h. Needs the constants `c` of DrawConstants.

vec3 to_eye(vec3 position) {
  return normalize(c.eye.xyz - c.eye.w * position);
}

vec3 mark_tint(vec3 color, uint marks) {
  for (int k = 0; k < 3; ++k)
    if ((marks & (1u << k)) != 0u) color = mix(color, unpackUnorm4x8(c.mark_colors[k]).rgb, mark_strength);
  return color;
}

float light_on(vec3 normal, vec3 eye) {
  const float sky = (c.flags & draw_z_up) != 0u ? normal.z : normal.y;
  return surface_light(dot(normal, c.light), sky, dot(normal, eye));
}
