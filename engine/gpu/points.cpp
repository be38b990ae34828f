#include "engine/gpu/points.h"

#include <algorithm>

#include "engine/geometry/check.h"
#include "engine/geometry/error.h"
#include "engine/gpu/skin_pass.h"

namespace sinew::gpu {
namespace {

std::vector<Eigen::Vector3f> to_float(std::span<const Eigen::Vector3d> values, const Eigen::Vector3d& centre) {
  std::vector<Eigen::Vector3f> out(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) out[i] = (values[i] - centre).cast<float>();
  return out;
}

/// On the device, or mapped and readable by the CPU.
template <class T>
Buffer filled(const Device& device, bool on_device, std::span<const T> values) {
  if (on_device) return upload(device, std::as_bytes(values));
  Buffer buffer = create_buffer(device, values.size_bytes(), Memory::Upload);
  std::ranges::copy(values, static_cast<T*>(buffer.mapped));
  return buffer;
}

/// Overwrites all of a buffer, through a staging buffer where it is not mapped.
void fill(const Device& device, Buffer& buffer, std::span<const Eigen::Vector3f> values) {
  if (values.empty()) return;
  if (buffer.mapped != nullptr) {
    std::ranges::copy(values, static_cast<Eigen::Vector3f*>(buffer.mapped));
    return;
  }
  const Buffer staging = filled(device, false, values);
  run_once(device, [&](VkCommandBuffer commands) {
    const VkBufferCopy region{0, 0, values.size_bytes()};
    vkCmdCopyBuffer(commands, staging.handle, buffer.handle, 1, &region);
  });
}

std::vector<Eigen::Vector3d> read(const Device& device, const Buffer& buffer, std::size_t count,
                                  const Eigen::Vector3d& centre) {
  const std::size_t bytes = count * sizeof(Eigen::Vector3f);
  Buffer staging;
  const Buffer* from = &buffer;
  if (buffer.mapped == nullptr && count > 0) {
    staging = create_buffer(device, bytes, Memory::Readback);
    run_once(device, [&](VkCommandBuffer commands) {
      const VkBufferCopy region{0, 0, bytes};
      vkCmdCopyBuffer(commands, buffer.handle, staging.handle, 1, &region);
      memory_barrier(commands, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                     {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
    });
    from = &staging;
  }
  std::vector<Eigen::Vector3d> out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = from->as<Eigen::Vector3f>()[i].cast<double>() + centre;
  return out;
}

}  // namespace

Points create_points(const Device& device, bool on_device, std::span<const Eigen::Vector3d> rest,
                     std::span<const Eigen::Vector3d> normals) {
  CHECK(normals.empty() || normals.size() == rest.size(), normals.size(), rest.size());
  Points points;
  points.count = rest.size();
  points.on_device = on_device;
  points.has_normals = !normals.empty();
  points.rest_bounds = bounds_of(rest);
  points.centre = points.rest_bounds.centre();
  const std::vector<Eigen::Vector3f> local = to_float(rest, points.centre);
  const std::vector<Eigen::Vector3f> directions = to_float(normals, Eigen::Vector3d::Zero());
  points.rest = filled<Eigen::Vector3f>(device, on_device, local);
  points.positions = filled<Eigen::Vector3f>(device, on_device, local);
  points.rest_normals = filled<Eigen::Vector3f>(device, on_device, directions);
  points.normals = filled<Eigen::Vector3f>(device, on_device, directions);
  points.colors = filled<PointColor>(device, false, std::vector<PointColor>(rest.size()));
  return points;
}

void set_rest(const Device& device, Points& points, std::span<const Eigen::Vector3d> rest,
              std::span<const Eigen::Vector3d> normals) {
  CHECK(rest.size() == points.count && normals.size() == (points.has_normals ? points.count : 0), rest.size(),
        normals.size(), points.count);
  points.rest_bounds = bounds_of(rest);
  points.centre = points.rest_bounds.centre();
  const std::vector<Eigen::Vector3f> local = to_float(rest, points.centre);
  const std::vector<Eigen::Vector3f> directions = to_float(normals, Eigen::Vector3d::Zero());
  fill(device, points.rest, local);
  fill(device, points.positions, local);
  fill(device, points.rest_normals, directions);
  fill(device, points.normals, directions);
}

void set_colors(Points& points, std::span<const PointColor> colors) {
  CHECK(colors.size() == points.count, colors.size(), points.count);
  std::copy(colors.begin(), colors.end(), colors_of(points).begin());
}

std::span<PointColor> colors_of(Points& points) {
  return points.colors.as<PointColor>().first(points.count);
}

void set_weights(const Device& device, Points& points, const SkinWeights& weights) {
  CHECK(weights.size() == points.count, weights.size(), points.count);
  if (weights.influences() > 0xffffffffu)
    throw file_error("weights", "fewer than 2^32 influences", std::to_string(weights.influences()));
  std::vector<std::uint32_t> offsets(weights.offsets.begin(), weights.offsets.end());
  points.influences = weights.influences();
  points.offsets = filled<std::uint32_t>(device, points.on_device, offsets);
  points.map_indices = filled<std::uint32_t>(device, points.on_device, weights.maps);
  points.weights = filled<float>(device, points.on_device, weights.weights);
}

void set_order(const Device& device, Points& points, std::span<const std::uint32_t> order) {
  CHECK(order.size() == points.count, order.size(), points.count);
  points.order = filled<std::uint32_t>(device, false, order);
}

void pose_points(const Device& device, Frame& frame, Points& points, const Pose& pose) {
  if (points.count == 0 || points.offsets.size == 0) return;
  write_maps(device, points, pose);
  if (!points.on_device) {
    skin_on_cpu(points);
    return;
  }
  record_skin(device, begin_pass(device, frame), points);
  end_pass(device, frame);
}

void set_positions(const Device& device, Points& points, std::span<const Eigen::Vector3d> positions,
                   std::span<const Eigen::Vector3d> normals) {
  CHECK(positions.size() == points.count && (normals.empty() || normals.size() == points.count), positions.size(),
        normals.size(), points.count);
  if (points.positions.mapped != nullptr) {
    const auto out = points.positions.as<Eigen::Vector3f>();
    for (std::size_t i = 0; i < points.count; ++i) out[i] = (positions[i] - points.centre).cast<float>();
  } else {
    fill(device, points.positions, to_float(positions, points.centre));
  }
  if (points.has_normals) fill(device, points.normals, to_float(normals, Eigen::Vector3d::Zero()));
}

std::vector<Eigen::Vector3d> read_positions(const Device& device, const Points& points) {
  return read(device, points.positions, points.count, points.centre);
}

std::vector<Eigen::Vector3d> read_normals(const Device& device, const Points& points) {
  return read(device, points.normals, points.has_normals ? points.count : 0, Eigen::Vector3d::Zero());
}

Triangles create_triangles(const Device& device, std::span<const std::uint32_t> indices) {
  CHECK(indices.size() % 3 == 0, indices.size());
  return {indices.size() / 3, filled<std::uint32_t>(device, !device.software, indices)};
}

}  // namespace sinew::gpu
