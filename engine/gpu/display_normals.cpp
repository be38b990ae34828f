#include "engine/gpu/display_normals.h"

#include <Eigen/Eigenvalues>

#include "engine/geometry/nearest.h"
#include "engine/geometry/parallel.h"

namespace sinew::gpu {
namespace {

constexpr int neighbours = 16;         ///< with the point itself
constexpr std::size_t block = 16'384;  ///< points of one query

Eigen::Vector3d least_spread(std::span<const Eigen::Vector3d> points, std::span<const std::uint32_t> near) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double count = 0;
  for (const std::uint32_t i : near) {
    if (i == NearestTree::none) break;
    mean += points[i];
    ++count;
  }
  if (count < 4) return Eigen::Vector3d::Zero();
  mean /= count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : near)
    if (i != NearestTree::none) spread += (points[i] - mean) * (points[i] - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(spread);
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  return normal.allFinite() ? normal : Eigen::Vector3d(0, 0, 0);
}

}  // namespace

std::vector<Eigen::Vector3d> display_normals(std::span<const Eigen::Vector3d> points) {
  std::vector<Eigen::Vector3d> finite, normals(points.size(), Eigen::Vector3d::Zero());
  std::vector<std::size_t> place;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) continue;
    finite.push_back(points[i]);
    place.push_back(i);
  }
  if (finite.empty()) return normals;
  const NearestTree tree(finite);
  std::vector<std::uint32_t> index(block * neighbours);
  std::vector<double> distance(block * neighbours);
  for (std::size_t first = 0; first < finite.size(); first += block) {
    const std::size_t count = std::min(block, finite.size() - first);
    tree.nearest(std::span(finite).subspan(first, count), neighbours, std::span(index).first(count * neighbours),
                 std::span(distance).first(count * neighbours));
    parallel_for(count, 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        normals[place[first + i]] = least_spread(finite, std::span(index).subspan(i * neighbours, neighbours));
    });
  }
  return normals;
}

}  // namespace sinew::gpu
