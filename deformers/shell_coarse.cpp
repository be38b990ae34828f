#include "deformers/shell_coarse.h"

#include <algorithm>

#include "deformers/shell_pose.h"
#include "engine/geometry/check.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/triangle.h"

namespace sinew {

std::unique_ptr<ShellCoarse> ShellCoarse::make(const ShellMesh& fine, std::size_t count,
                                               const std::function<bool(double)>& progress) {
  const auto go_on = [&] { return !progress || progress(0.5); };
  PoseDecimated decimated = decimated_together(fine.poses, fine.triangles, count, {}, go_on);
  if (decimated.stopped) return nullptr;
  auto out = std::make_unique<ShellCoarse>();
  out->vertices_ = std::move(decimated.vertices);
  out->places_ = std::move(decimated.places);
  out->triangles_ = std::move(decimated.triangles);
  out->number_.assign(fine.size(), none);
  for (Index c = 0; c < out->vertices_.size(); ++c) out->number_[out->vertices_[c]] = c;
  for (Triangle& t : out->triangles_)
    for (Index& v : t) v = out->number_[v];
  return out;
}

std::vector<Vec3> ShellCoarse::coarse_of(std::span<const Vec3> fine) const {
  std::vector<Vec3> out;
  out.reserve(vertices_.size());
  for (const Index v : vertices_) out.push_back(fine[v]);
  return out;
}

ShellTie ShellCoarse::tie_of(Index fine, std::span<const Vec3> rest) const {
  const PoseDecimated::Place& place = places_[fine];
  CHECK(place.triangle != PoseDecimated::none, fine);
  const Triangle& t = triangles_[place.triangle];
  const TriangleCoordinates at =
      coordinates_in(rest[fine], rest[vertices_[t[0]]], rest[vertices_[t[1]]], rest[vertices_[t[2]]]);
  return {t, at.weights, at.height};
}

Pose ShellCoarse::fine_maps(const Pose& coarse) const {
  Pose out(number_.size(), identity_map());
  parallel_for(out.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const PoseDecimated::Place& place = places_[v];
      if (place.triangle == PoseDecimated::none) continue;
      // As displacements, so that what is at rest stays there to the last bit.
      for (std::size_t k = 0; k < 3; ++k)
        out[v] +=
            place.coordinates[static_cast<Eigen::Index>(k)] * (coarse[triangles_[place.triangle][k]] - identity_map());
    }
  });
  return out;
}

std::vector<double> ShellCoarse::fine_values(std::span<const double> coarse) const {
  std::vector<double> out(number_.size(), 0);
  for (std::size_t v = 0; v < out.size(); ++v)
    if (const PoseDecimated::Place& place = places_[v]; place.triangle != PoseDecimated::none)
      for (std::size_t k = 0; k < 3; ++k)
        out[v] += place.coordinates[static_cast<Eigen::Index>(k)] * coarse[triangles_[place.triangle][k]];
  return out;
}

std::vector<Vec3> ShellCoarse::reconstruct(const ShellMesh& fine, std::span<const Vec3> x, std::span<const Index> held,
                                           std::span<const Vec3> targets, const std::function<bool(double)>& progress) {
  std::vector<Index> anchors(held.begin(), held.end()), exact(held.size());
  std::vector<Vec3> positions(targets.begin(), targets.end());
  std::vector<bool> taken(fine.size(), false);
  for (Index k = 0; k < held.size(); ++k) {
    exact[k] = k;
    taken[held[k]] = true;
  }
  for (std::size_t c = 0; c < vertices_.size(); ++c)
    if (!taken[vertices_[c]]) {
      anchors.push_back(vertices_[c]);
      positions.push_back(x[c]);
    }
  if (detail_ == nullptr || !std::ranges::equal(detail_held_, held)) {
    detail_ = std::make_unique<ShellDetail>(fine.rest(), fine.triangles, std::move(anchors), exact, progress);
    detail_held_.assign(held.begin(), held.end());
    if (!detail_->ready()) {
      detail_.reset();
      return {};
    }
  }
  return detail_->reconstruct(positions);
}

}  // namespace sinew
