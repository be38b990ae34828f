#pragma once
/// Splats: Gaussians with a colour that depends on the direction from which they are seen [Kerbl et al.: 3D Gaussian
/// Splatting for Real-Time Radiance Field Rendering, SIGGRAPH 2023], and what they look like from a camera: ellipses
/// on the screen [Zwicker et al.: EWA Volume Splatting, VIS 2001].
///
///   S = R diag(exp(2 s)) R^T                    R of the quaternion (w, x, y, z), s the three log-scales
///   S' = J S J^T + 0.3 I                        J: derivative of the pixel position by the position; pixels^2
///   alpha(x) = opacity exp(-x^T S'^-1 x / 2)    x: pixels from the middle; nothing beyond three standard deviations
///   color(d) = 1/2 + sum_k c_k Y_k(d)           d: unit, from the eye; Y_k: real spherical harmonics, degree up to 3
///
/// Colours are blended as they are written, without gamma, as the files were made. To pick splats, draw their centres
/// as a cloud in the scene that is picked from.

#include <Eigen/Core>
#include <vector>

#include "engine/geometry/shape.h"
#include "engine/gpu/scene.h"
#include "shaders/shared.h"

namespace sinew::gpu {

struct Splats {
  std::size_t count = 0;
  Eigen::Vector3d centre{0, 0, 0};  ///< what follows is relative to it
  std::vector<Eigen::Vector3f> positions;
  struct Covariance {
    float xx, xy, xz, yy, yz, zz;
  };
  std::vector<Covariance> covariances;
  std::vector<float> opacities;            ///< 0..1; not finite: not drawn
  int degree = 0;                          ///< of the harmonics, 0..3
  std::vector<Eigen::Vector3f> harmonics;  ///< (degree + 1)^2 a splat: red, green, blue of each c_k

  std::size_t coefficients() const {
    return static_cast<std::size_t>(degree + 1) * static_cast<std::size_t>(degree + 1);
  }
};

/// Whether the shape's points have a Quaternion, a LogScale and a number "opacity" each.
bool holds_splats(const Shape& shape);

/// Of a shape that holds them. Opacity is the logistic function of the file's; colours are of "f_dc" and "f_rest", or
/// grey where they are missing.
Splats create_splats(const Shape& shape);

/// Mixes in a colour, seen from everywhere. part: 0 nothing of it, 1 nothing else.
void tint(Splats& splats, std::size_t i, const Eigen::Vector3f& color, float part);

/// Red, green, blue, not below 0.
Eigen::Vector3f splat_color(const Splats& splats, std::size_t i, const Eigen::Vector3f& direction);

/// Where most splats are: reconstructions have some far outside, which would make a picture of all of them empty.
Bounds bulk_bounds(const Splats& splats);

/// All splats of the scene that can be seen, the farthest first. Left out: what is not finite, before the near plane,
/// beside the picture, or fainter than a step of colour.
std::vector<shared::SplatInstance> splat_instances(const Scene& scene, VkExtent2D extent);

}  // namespace sinew::gpu
