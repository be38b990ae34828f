#pragma once
/// The ground grid, drawn by the CPU as ground.frag does it.

#include <vector>

#include "engine/gpu/scene.h"

namespace sinew::gpu {

/// What a row of the grid is: opacity 0..1 and depth of each pixel (and of some beyond the last).
struct GroundRow {
  std::vector<float> opacity, depth;
};

class RasterGround {
 public:
  RasterGround(const Scene& scene, VkExtent2D extent, int scale);

  /// Row y of a raster of scale times the picture's size.
  void row(int y, GroundRow& out) const;

 private:
  bool show_ = false;
  int width_ = 0;
  Eigen::Matrix3f to_plane_;  ///< (x, y, 1) of a raster pixel -> (u, v, 1) / w, in cells from the middle
  Eigen::Vector3f to_depth_;  ///< depth = to_depth . (u, v, 1) / w
  Eigen::Vector2f origin_;
  float radius_ = 0, opacity_ = 0, scale_ = 1;
};

}  // namespace sinew::gpu
