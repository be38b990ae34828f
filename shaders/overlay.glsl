// How much of a line or dot is seen where something may stand before it.

layout(set = 0, binding = 1) uniform sampler2D depths;

float seen(float z, float hidden) {
  const float before = texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r;
  return z * c.depth_bias.x + c.depth_bias.y >= before ? 1.0 : hidden;
}
