#include "engine/gpu/skin_pass.h"

#include <Eigen/Geometry>
#include <cmath>

#include "engine/geometry/parallel.h"
#include "engine/gpu/pipeline.h"
#include "shaders/shared.h"

namespace sinew::gpu {
namespace {

constexpr std::size_t block = 4096;  ///< points of one parallel block

/// One column a vector register: the fourth number is not used.
using Map = Eigen::Matrix<float, 4, 4>;

Map blended(const Points& points, std::span<const Map> maps, std::size_t i) {
  const auto offsets = points.offsets.as<std::uint32_t>();
  const auto indices = points.map_indices.as<std::uint32_t>();
  const auto weights = points.weights.as<float>();
  Map sum = Map::Zero();
  for (std::size_t e = offsets[i]; e < offsets[i + 1]; ++e) sum += weights[e] * maps[indices[e]];
  return sum;
}

Eigen::Vector3f skinned_normal(const Eigen::Matrix3f& M, const Eigen::Vector3f& n) {
  const Eigen::Vector3f turned =
      M.col(1).cross(M.col(2)) * n.x() + M.col(2).cross(M.col(0)) * n.y() + M.col(0).cross(M.col(1)) * n.z();
  const float squared = turned.squaredNorm();
  return squared > 0 ? Eigen::Vector3f(turned * std::sqrt(n.squaredNorm() / squared)) : n;
}

}  // namespace

void write_maps(const Device& device, Points& points, const Pose& pose) {
  grow(device, points.maps, pose.size() * 12 * sizeof(float), Memory::Upload);
  const auto out = points.maps.as<float>();
  for (std::size_t j = 0; j < pose.size(); ++j) {
    const Eigen::Matrix3d difference = pose[j].leftCols<3>() - Eigen::Matrix3d::Identity();
    Eigen::Map<Eigen::Matrix<float, 3, 4>> map(out.data() + 12 * j);
    map.leftCols<3>() = difference.cast<float>();
    map.col(3) = (difference * points.centre + pose[j].col(3)).cast<float>();
  }
}

void record_skin(const Device& device, VkCommandBuffer commands, const Points& points) {
  const Access skin{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
  const Access users{VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT | VK_PIPELINE_STAGE_2_COPY_BIT,
                     VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_TRANSFER_READ_BIT};
  memory_barrier(commands, users, skin);
  shared::SkinConstants constants{};
  constants.rest = points.rest.address;
  constants.rest_normals = points.has_normals ? points.rest_normals.address : 0;
  constants.offsets = points.offsets.address;
  constants.map_indices = points.map_indices.address;
  constants.weights = points.weights.address;
  constants.maps = points.maps.address;
  constants.positions = points.positions.address;
  constants.normals = points.has_normals ? points.normals.address : 0;
  constants.count = static_cast<std::uint32_t>(points.count);

  const Pipeline& pipeline = *device.skin_pipeline;
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle);
  // One dispatch has at most 65,535 groups on some devices.
  const std::size_t most = std::size_t{65'535} * shared::skin_group;
  for (std::size_t first = 0; first < points.count; first += most) {
    constants.first = static_cast<std::uint32_t>(first);
    push_constants(commands, pipeline, constants);
    const std::size_t here = std::min(most, points.count - first);
    vkCmdDispatch(commands, static_cast<std::uint32_t>((here + shared::skin_group - 1) / shared::skin_group), 1, 1);
  }
  memory_barrier(commands, skin, users);
}

void skin_on_cpu(Points& points) {
  const auto packed = points.maps.as<float>();
  std::vector<Map> maps(packed.size() / 12);
  for (std::size_t j = 0; j < maps.size(); ++j) {
    maps[j].setZero();
    maps[j].topRows<3>() = Eigen::Map<const Eigen::Matrix<float, 3, 4>>(packed.data() + 12 * j);
  }
  const auto rest = points.rest.as<Eigen::Vector3f>();
  const auto rest_normals = points.rest_normals.as<Eigen::Vector3f>();
  const auto positions = points.positions.as<Eigen::Vector3f>();
  const auto normals = points.normals.as<Eigen::Vector3f>();
  parallel_for(points.count, block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Map sum = blended(points, maps, i);
      const Eigen::Vector3f p = rest[i];
      positions[i] = p + (sum.col(0) * p.x() + sum.col(1) * p.y() + sum.col(2) * p.z() + sum.col(3)).head<3>();
      if (!points.has_normals) continue;
      normals[i] = skinned_normal(Eigen::Matrix3f::Identity() + sum.topLeftCorner<3, 3>(), rest_normals[i]);
    }
  });
}

}  // namespace sinew::gpu
