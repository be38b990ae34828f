#include "engine/gpu/raster_ground.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "engine/gpu/draw_overlay.h"

namespace sinew::gpu {
namespace {

/// Pixels that are computed at once: whole vectors of any processor.
constexpr int lanes = 8;
using Lanes = Eigen::Array<float, lanes, 1>;

/// How much of a pixel a line at a whole number of cells covers.
Lanes line(const Lanes& cells, const Lanes& pixel) {
  const Lanes from_line = (cells - (cells + 0.5f).floor()).abs() / pixel;
  return (1 - from_line).max(0) * (1.4f - 3 * pixel).max(0).min(1);
}

}  // namespace

RasterGround::RasterGround(const Scene& scene, VkExtent2D extent, int scale)
    : show_(scene.ground.show), width_(static_cast<int>(extent.width) * scale) {
  const shared::GroundConstants c = ground_constants(scene, extent);
  const Eigen::Matrix4d clip = c.clip.cast<double>();
  Eigen::Matrix3d from_plane;  // (u, v, 1) -> (x, y, 1) w
  from_plane << clip(0, 0), clip(0, 1), clip(0, 3), clip(1, 0), clip(1, 1), clip(1, 3), clip(3, 0), clip(3, 1),
      clip(3, 3);
  Eigen::Matrix3d to_ndc = Eigen::Matrix3d::Identity();
  to_ndc(0, 0) = 2.0 / (extent.width * scale);
  to_ndc(1, 1) = 2.0 / (extent.height * scale);
  to_ndc(0, 2) = to_ndc(1, 2) = -1;
  // Seen from within its plane the ground is a line: nothing is drawn.
  if (!(std::abs(from_plane.determinant()) > 1e-12 * std::pow(from_plane.norm(), 3))) show_ = false;
  if (!show_) return;
  to_plane_ = (from_plane.inverse() * to_ndc).cast<float>();
  to_depth_ = Eigen::Vector3d(clip(2, 0), clip(2, 1), clip(2, 3)).cast<float>();
  origin_ = c.origin;
  radius_ = c.radius;
  opacity_ = static_cast<float>(scene.look.grid.a) / 255.0f;
  scale_ = static_cast<float>(scale);
}

void RasterGround::row(int y, GroundRow& out) const {
  const int blocks = (width_ + lanes - 1) / lanes;
  const std::size_t padded = static_cast<std::size_t>(blocks) * lanes;
  out.opacity.assign(padded, 0.0f);
  out.depth.assign(padded, 0.0f);
  if (!show_) return;
  const Eigen::Matrix3f T = to_plane_;
  const Eigen::Vector3f start = T.col(1) * (static_cast<float>(y) + 0.5f) + T.col(2);
  for (int block = 0; block < blocks; ++block) {
    const float first = static_cast<float>(block * lanes) + 0.5f;
    const Lanes x = Lanes::LinSpaced(first, first + lanes - 1);
    const Lanes pu = start.x() + T(0, 0) * x, pv = start.y() + T(1, 0) * x, pw = start.z() + T(2, 0) * x;
    const Lanes depth = to_depth_.x() * pu + to_depth_.y() * pv + to_depth_.z() * pw;
    const Lanes w = 1 / pw.max(1e-12f);
    const Lanes u = pu * w, v = pv * w;
    const Lanes fade = 1 - (u.square() + v.square()) / (radius_ * radius_);
    if (!((pw > 0) && (fade > 0)).any()) continue;  // above the horizon, or too far
    // What a pixel of the picture spans: |du/dx| + |du/dy| of the quotient.
    const Lanes du = ((T(0, 0) - u * T(2, 0)).abs() + (T(0, 1) - u * T(2, 1)).abs()) * w * scale_;
    const Lanes dv = ((T(1, 0) - v * T(2, 0)).abs() + (T(1, 1) - v * T(2, 1)).abs()) * w * scale_;
    const Lanes fine = line(u + origin_.x(), du).max(line(v + origin_.y(), dv));
    const Lanes coarse = line(0.1f * (u + origin_.x()), 0.1f * du).max(line(0.1f * (v + origin_.y()), 0.1f * dv));
    const Lanes opacity = opacity_ * fade.max(0).square() * (0.65f * fine).max(coarse);
    Eigen::Map<Lanes>(out.opacity.data() + block * lanes) =
        ((pw > 0) && (depth > 0) && (depth <= 1)).select(opacity, 0.0f);
    Eigen::Map<Lanes>(out.depth.data() + block * lanes) = depth;
  }
}

}  // namespace sinew::gpu
