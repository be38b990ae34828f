// What C++ and GLSL must agree on: push constants (scalar layout), marks and the light. Read by both.
#ifdef __cplusplus
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace sinew::gpu::shared {

using uint = std::uint32_t;
using uint64_t = std::uint64_t;
using vec2 = Eigen::Matrix<float, 2, 1, Eigen::DontAlign>;
using vec3 = Eigen::Matrix<float, 3, 1, Eigen::DontAlign>;
using vec4 = Eigen::Matrix<float, 4, 1, Eigen::DontAlign>;
using mat4 = Eigen::Matrix<float, 4, 4, Eigen::DontAlign>;
#define SHARED_FUNCTION inline
#define SHARED_CONST inline constexpr
#define SHARED_SIZE(type, bytes) static_assert(sizeof(type) == (bytes))
inline float max(float a, float b) {
  return a > b ? a : b;
}
using std::sqrt;
#else
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define SHARED_FUNCTION
#define SHARED_CONST const
#define SHARED_SIZE(type, bytes)
#endif

// Bits of the fourth byte of a point's colour.
SHARED_CONST uint mark_handle = 1u;
SHARED_CONST uint mark_fixed = 2u;
SHARED_CONST uint mark_rigid = 4u;
SHARED_CONST uint mark_selected = 8u;
SHARED_CONST uint mark_hidden = 16u;

// Skinning: addresses of tightly packed arrays. maps: m x 12 floats, columns of [A - I | t] (CSR as in skin_weights.h).
struct SkinConstants {
  uint64_t rest;          // n x vec3, relative to the points' centre
  uint64_t rest_normals;  // n x vec3, or 0
  uint64_t offsets;       // n + 1 uint
  uint64_t map_indices;   // uint each
  uint64_t weights;       // float each
  uint64_t maps;
  uint64_t positions;  // out, n x vec3
  uint64_t normals;    // out, n x vec3, or 0
  uint first;          // points before this dispatch
  uint count;          // n
};
SHARED_SIZE(SkinConstants, 72);
SHARED_CONST uint skin_group = 64u;

// Points and meshes, drawn or picked.
SHARED_CONST uint draw_flat = 1u;     // faces shaded flat
SHARED_CONST uint draw_normals = 2u;  // points have normals
SHARED_CONST uint draw_ghost = 4u;    // see-through, brighter towards its outline
SHARED_CONST uint draw_z_up = 8u;     // the sky is where z grows; otherwise y
SHARED_CONST uint draw_smooth = 16u;  // four samples a pixel
struct DrawConstants {
  mat4 clip;            // from the points' own coordinates
  vec4 eye;             // w 1: the eye in those coordinates; w 0: the direction towards it (orthographic)
  vec3 light;           // unit, towards the key light
  uint mark_colors[3];  // handle, fixed, rigid, RGBA8
  uint flags;           // draw_*
  float size;           // of a point, pixels
  uint ghost_color;     // RGBA8
  uint first_id;        // picking: id of the first point or face
};
SHARED_SIZE(DrawConstants, 120);

// The picture behind everything, and the last pass over what was drawn.
struct ComposeConstants {
  uint top, bottom;    // backdrop, RGBA8
  uint outline;        // around what is selected, RGBA8
  float edl_strength;  // 0: none
  float edl_radius;    // pixels
  vec2 size;           // of the picture, pixels
  float linear_depth;  // 0: perspective; otherwise what depth 1 is in units of the EDL's depth (orthographic)
};
SHARED_SIZE(ComposeConstants, 32);

struct OverlayConstants {
  mat4 clip;
  vec2 size;        // of the picture, pixels
  vec2 depth_bias;  // depth * x + y is compared with what was drawn
};
SHARED_SIZE(OverlayConstants, 80);

struct GroundConstants {
  mat4 clip;     // from plane coordinates (u, v, 0), unit = one cell, relative to the middle
  vec2 origin;   // plane coordinates of the middle, cells, modulo 10
  uint color;    // RGBA8
  float radius;  // cells; fades to nothing there
};
SHARED_SIZE(GroundConstants, 80);

// A Gaussian splat as it is seen (engine/gpu/splats.h); pixels, y downwards.
struct SplatInstance {
  vec3 at;     // middle and depth
  vec3 conic;  // a, b, c of a x^2 + 2 b x y + c y^2: squared standard deviations from the middle
  vec2 reach;  // half the sides of the box that it fills
  vec4 color;  // red, green, blue; opacity in the middle
};
SHARED_SIZE(SplatInstance, 48);
struct SplatConstants {
  vec2 size;  // of the picture, pixels
};
SHARED_SIZE(SplatConstants, 8);
SHARED_CONST float splat_low_pass = 0.3f;        // least variance along any direction, pixels^2
SHARED_CONST float splat_cut = 9.0f;             // squared standard deviations where it ends
SHARED_CONST float splat_least = 1.0f / 255.0f;  // opacity that is too faint to draw
SHARED_CONST float harmonic_0 = 0.28209479f;     // the spherical harmonic of degree 0

// Light on a surface from the three cosines of its normal: to the key light, to the sky, to the eye. 0..1, as the
// brightness seen (the square root stands for the display's gamma): a soft key light that reaches a little around the
// edge, a sky brighter than the ground, and some light from the eye so that no side is lost.
SHARED_FUNCTION float surface_light(float to_light, float to_sky, float to_eye) {
  const float key = max(0.0f, (to_light + 0.15f) / 1.15f);
  return sqrt(0.10f + 0.08f * to_sky + 0.16f * max(0.0f, to_eye) + 0.56f * key);
}

// How much of a mark's colour is mixed in.
SHARED_CONST float mark_strength = 0.62f;

// A scan without normals is lit by its depth alone.
SHARED_CONST float unlit = 0.80f;

// Eye-dome lighting [Boucheny 2009]: how much darker a pixel is, from the sum over the neighbours on a ring of how much
// nearer they are, log2(depth here / depth there), each at most edl_limit so that an outline stays a line. With
// reversed depth z = near / depth that logarithm is (z_there - z_here) / (z_here ln 2) to first order, which is what is
// used.
SHARED_CONST int edl_taps = 8;
SHARED_CONST float edl_limit = 0.04f;
SHARED_CONST float inverse_ln2 = 1.442695f;
// exp(-t) where it is small, and cheaper.
SHARED_FUNCTION float edl_shade(float t) {
  return 1.0f / (1.0f + t + 0.5f * t * t);
}

// Points up to this size are squares: a disc could miss every pixel.
SHARED_CONST float square_size = 1.5f;

#ifdef __cplusplus
}  // namespace sinew::gpu::shared
#endif
