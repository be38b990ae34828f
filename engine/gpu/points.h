#pragma once
/// Points: one shape as the device has it. Float coordinates relative to a centre of their own, so that they are as
/// fine as float can be; colours with marks; skinning weights. Nothing here may be called while a picture that shows
/// them is in flight (call it between begin_frame and submit).

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/bounds.h"
#include "engine/geometry/skin_weights.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/frame.h"

namespace sinew::gpu {

/// Colour of a point as in the file, and its marks (mark_handle ... of shaders/shared.h).
struct PointColor {
  std::uint8_t r = 200, g = 200, b = 200, marks = 0;
};

struct Points {
  std::size_t count = 0;
  bool has_normals = false;
  bool on_device = false;           ///< skinned there; otherwise all buffers are mapped and the CPU skins into them
  Eigen::Vector3d centre{0, 0, 0};  ///< of the rest shape; what the device has is relative to it
  Bounds rest_bounds;               ///< of the finite rest points
  Buffer rest, rest_normals;        ///< n x vec3 float
  Buffer positions, normals;        ///< n x vec3 float, bent
  Buffer colors;                    ///< n x PointColor, always mapped
  Buffer order;                     ///< n indices, most telling first (level_of_detail.h), always mapped; or none
  Buffer offsets, map_indices, weights;  ///< CSR rows: n + 1 uint; uint and float an influence; or none
  Buffer maps;                           ///< of the present pose: [A - I | t] column by column, always mapped
  std::size_t influences = 0;
};

/// n points, relative to the scene's origin; n normals or none. All colours are the standard grey.
Points create_points(const Device& device, bool on_device, std::span<const Eigen::Vector3d> rest,
                     std::span<const Eigen::Vector3d> normals);

/// The rest shape of another frame, with the same n and normals if there were any. The bent shape is then this one.
void set_rest(const Device& device, Points& points, std::span<const Eigen::Vector3d> rest,
              std::span<const Eigen::Vector3d> normals);

void set_colors(Points& points, std::span<const PointColor> colors);  ///< n
std::span<PointColor> colors_of(Points& points);                      ///< to change some of them in place
void set_weights(const Device& device, Points& points, const SkinWeights& weights);          ///< weights.size() == n
void set_order(const Device& device, Points& points, std::span<const std::uint32_t> order);  ///< a permutation

/// Bends the points by the pose [Sumner et al. 2007, eq. 4; see skin_weights.h], on the path they were made for. The
/// device path records a pass into `frame`; the other is done on return. Points without weights stay at rest.
void pose_points(const Device& device, Frame& frame, Points& points, const Pose& pose);

/// Bent positions that the CPU already has (and normals, or none to keep the present ones).
void set_positions(const Device& device, Points& points, std::span<const Eigen::Vector3d> positions,
                   std::span<const Eigen::Vector3d> normals);

/// The bent positions (and normals) back from where they are, relative to the scene's origin. Waits.
std::vector<Eigen::Vector3d> read_positions(const Device& device, const Points& points);
std::vector<Eigen::Vector3d> read_normals(const Device& device, const Points& points);

/// Triangles over points, 3 indices each; mapped where the device is the processor.
struct Triangles {
  std::size_t count = 0;  ///< triangles
  Buffer indices;
};
Triangles create_triangles(const Device& device, std::span<const std::uint32_t> indices);

}  // namespace sinew::gpu
