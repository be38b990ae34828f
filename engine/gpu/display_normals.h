#pragma once
/// Normals to light points with that have none: the direction in which a point's neighbours spread least [Hoppe et al.
/// 1992, section 3.2]. Which side is out is not told; the light is the same on both.

#include <Eigen/Core>
#include <span>
#include <vector>

namespace sinew::gpu {

/// n unit normals; zero where a point is not finite or has fewer than three other points. About a second for a million
/// points and core; the result does not depend on the number of threads.
std::vector<Eigen::Vector3d> display_normals(std::span<const Eigen::Vector3d> points);

}  // namespace sinew::gpu
