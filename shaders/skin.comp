#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#include "shared.h"

// Moves points and normals by their weights (the twin of engine/geometry/skin.cpp):
//   p' = p + sum_j w_ij ((A_j - I) p + t_j),  n' = cofactor(I + sum_j w_ij (A_j - I)) n, of the length of n.

layout(local_size_x = skin_group) in;
layout(push_constant, scalar) uniform Constants { SkinConstants c; };

layout(buffer_reference, scalar) readonly buffer Vec3s { vec3 at[]; };
layout(buffer_reference, scalar) writeonly buffer Vec3Results { vec3 at[]; };
layout(buffer_reference, scalar) readonly buffer Uints { uint at[]; };
layout(buffer_reference, scalar) readonly buffer Floats { float at[]; };
struct Map { vec3 x, y, z, t; };
layout(buffer_reference, scalar) readonly buffer Maps { Map at[]; };

vec3 skinned_normal(mat3 M, vec3 n) {
  const vec3 turned = cross(M[1], M[2]) * n.x + cross(M[2], M[0]) * n.y + cross(M[0], M[1]) * n.z;
  const float squared = dot(turned, turned);
  return squared > 0.0 ? turned * sqrt(dot(n, n) / squared) : n;
}

void main() {
  const uint i = c.first + gl_GlobalInvocationID.x;
  if (i >= c.count) return;
  const uint begin = Uints(c.offsets).at[i], end = Uints(c.offsets).at[i + 1u];
  Map sum = Map(vec3(0), vec3(0), vec3(0), vec3(0));
  for (uint e = begin; e < end; ++e) {
    const float w = Floats(c.weights).at[e];
    const Map m = Maps(c.maps).at[Uints(c.map_indices).at[e]];
    sum.x += w * m.x;
    sum.y += w * m.y;
    sum.z += w * m.z;
    sum.t += w * m.t;
  }
  const vec3 p = Vec3s(c.rest).at[i];
  Vec3Results(c.positions).at[i] = p + (sum.x * p.x + sum.y * p.y + sum.z * p.z + sum.t);
  if (c.normals == 0ul) return;
  const vec3 n = Vec3s(c.rest_normals).at[i];
  Vec3Results(c.normals).at[i] = skinned_normal(mat3(1) + mat3(sum.x, sum.y, sum.z), n);
}
