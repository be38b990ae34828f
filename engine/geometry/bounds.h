#pragma once
/// Bounds: the axis-aligned box of the finite points. Its diagonal is the length that every tolerance is measured in.

#include <Eigen/Core>
#include <limits>
#include <span>

namespace sinew {

struct Bounds {
  Eigen::Vector3d min = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d max = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());

  bool empty() const { return !(min.x() <= max.x()); }
  Eigen::Vector3d centre() const { return empty() ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(0.5 * (min + max)); }
  double diagonal() const { return empty() ? 0 : (max - min).norm(); }
  void add(const Eigen::Vector3d& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
};

/// Box of the points whose three coordinates are finite.
Bounds bounds_of(std::span<const Eigen::Vector3d> points);

/// x -> (x - centre) * scale: the diagonal becomes 1. All solving happens in these coordinates, because the energies
/// mix numbers without a unit and squared lengths (design: scale). Scale is 1 where the points have no extent.
struct Normalization {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double scale = 1;

  Eigen::Vector3d apply(const Eigen::Vector3d& p) const { return (p - centre) * scale; }
  Eigen::Vector3d undo(const Eigen::Vector3d& p) const { return p / scale + centre; }
};
Normalization normalization_of(const Bounds& bounds);

}  // namespace sinew
