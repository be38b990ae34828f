#include "engine/gpu/paths.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "engine/gpu/points.h"
#include "engine/gpu/skin_pass.h"

namespace sinew::gpu {
namespace {

/// Points on a spiral, each following four of a hundred maps.
SkinWeights sample_weights(std::size_t maps) {
  SkinWeights weights;
  for (std::size_t i = 0; i < measured_points; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      weights.maps.push_back(static_cast<std::uint32_t>((i / 97 + k) % maps));
      weights.weights.push_back(0.25f);
    }
    weights.offsets.push_back(weights.maps.size());
  }
  return weights;
}

Points sample_points(const Device& device, bool on_device, std::size_t maps) {
  std::vector<Eigen::Vector3d> positions;
  for (std::size_t i = 0; i < measured_points; ++i) {
    const double t = static_cast<double>(i) / measured_points;
    positions.emplace_back(t * std::cos(100 * t), t * std::sin(100 * t), t);
  }
  Points points = create_points(device, on_device, positions, {});
  set_weights(device, points, sample_weights(maps));
  return points;
}

/// The best of some runs: the first compiles the shader on some drivers.
double best_milliseconds(const Device& device, bool on_device) {
  const Pose pose(100, identity_map());
  Points points = sample_points(device, on_device, pose.size());
  Frame frame = create_frame(device);
  double best = 1e9;
  for (int run = 0; run < 4; ++run) {
    const auto start = std::chrono::steady_clock::now();
    begin_frame(device, frame);
    pose_points(device, frame, points, pose);
    submit(device, frame, VK_NULL_HANDLE, VK_NULL_HANDLE);
    finish(device, frame);
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
    best = std::min(best, taken.count());
  }
  return best;
}

}  // namespace

Paths measure_paths(const Device& device) {
  Paths paths;
  paths.device_skin_ms = best_milliseconds(device, true);
  paths.cpu_skin_ms = best_milliseconds(device, false);
  paths.skin_on_device = paths.device_skin_ms < paths.cpu_skin_ms;
  paths.draw_on_device = !device.software;
  paths.sentence =
      device.name.substr(0, device.name.find(" (")) + (paths.skin_on_device ? ", GPU skinning" : ", CPU skinning");
  return paths;
}

}  // namespace sinew::gpu
