#include "engine/gpu/raster.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/geometry/parallel.h"
#include "engine/gpu/draw_shapes.h"

namespace sinew::gpu {
namespace {

constexpr std::size_t block = 8192;  ///< points of one parallel block

std::uint64_t key_of(float depth, std::uint32_t id) {
  return static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(depth)) << 32 | ~id;
}

void project_points(RasterItem& item, int width, int height) {
  const auto positions = (item.rest ? item.points->rest : item.points->positions).as<Eigen::Vector3f>();
  const auto colors = item.points->colors.as<PointColor>();
  const bool ordered = item.triangles == nullptr && item.count < item.points->count && item.points->order.size > 0;
  const auto order = item.points->order.as<std::uint32_t>();
  const Eigen::Matrix4f clip = item.constants.clip;
  const auto w = static_cast<float>(width), h = static_cast<float>(height);
  item.projected.resize(item.count);
  parallel_for(item.count, block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = ordered ? order[k] : k;
      const Eigen::Vector4f p = clip.col(0) * positions[i].x() + clip.col(1) * positions[i].y() +
                                clip.col(2) * positions[i].z() + clip.col(3);
      const float inverse = 1 / p.w();
      const Eigen::Vector3f at((0.5f + 0.5f * p.x() * inverse) * w, (0.5f + 0.5f * p.y() * inverse) * h,
                               p.z() * inverse);
      // Written so that NaN is not seen either.
      const bool seen = p.w() > 0 && at.z() > 0 && at.z() <= 1 && (colors[i].marks & shared::mark_hidden) == 0;
      item.projected[k] = seen ? at : Eigen::Vector3f::Zero();
    }
  });
}

/// A square of one pixel up to square_size, otherwise the pixels whose centres are within the radius.
void splat_points(RasterImage& image, const RasterItem& item, int first_row, int end_row) {
  const bool ordered = item.count < item.points->count && item.points->order.size > 0;
  const auto order = item.points->order.as<std::uint32_t>();
  const float radius = 0.5f * item.constants.size, squared = radius * radius;
  const bool square = item.constants.size <= shared::square_size;
  const float low = static_cast<float>(first_row) - radius, high = static_cast<float>(end_row) + radius;
  const auto right = static_cast<float>(image.width) + radius;
  for (std::size_t k = 0; k < item.count; ++k) {
    const Eigen::Vector3f& p = item.projected[k];
    if (!(p.z() > 0) || p.y() < low || p.y() > high || p.x() < -radius || p.x() > right) continue;
    const std::uint64_t key = key_of(p.z(), item.first_id + (ordered ? order[k] : static_cast<std::uint32_t>(k)));
    const int top = std::max(first_row, static_cast<int>(std::ceil(p.y() - radius - 0.5f)));
    const int bottom = std::min(end_row - 1, static_cast<int>(std::floor(p.y() + radius - 0.5f)));
    for (int y = top; y <= bottom; ++y) {
      const float dy = static_cast<float>(y) + 0.5f - p.y();
      const float half = square ? radius : std::sqrt(std::max(0.0f, squared - dy * dy));
      const int left = std::max(0, static_cast<int>(std::ceil(p.x() - half - 0.5f)));
      const int last = std::min(image.width - 1, static_cast<int>(std::floor(p.x() + half - 0.5f)));
      std::uint64_t* row = image.keys.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
      for (int x = left; x <= last; ++x) row[x] = std::max(row[x], key);
    }
  }
}

/// Twice the signed area of a, b, c on the screen.
float area(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Pixels whose centres are inside; z is linear on the screen.
void fill_triangle(RasterImage& image, const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                   std::uint32_t id, int first_row, int end_row) {
  const float whole = area(a, b, c);
  if (whole == 0) return;
  const auto pixel = [](float x, int least, int most) {
    return static_cast<int>(std::clamp(x, static_cast<float>(least), static_cast<float>(most)));
  };
  const int top = pixel(std::ceil(std::min({a.y(), b.y(), c.y()}) - 0.5f), first_row, end_row);
  const int bottom = pixel(std::floor(std::max({a.y(), b.y(), c.y()}) - 0.5f), first_row - 1, end_row - 1);
  const int left = pixel(std::ceil(std::min({a.x(), b.x(), c.x()}) - 0.5f), 0, image.width);
  const int right = pixel(std::floor(std::max({a.x(), b.x(), c.x()}) - 0.5f), -1, image.width - 1);
  const float inverse = 1 / whole;
  for (int y = top; y <= bottom; ++y) {
    std::uint64_t* row = image.keys.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
    for (int x = left; x <= right; ++x) {
      const Eigen::Vector3f p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0);
      const float u = area(b, c, p) * inverse, v = area(c, a, p) * inverse, w = 1 - u - v;
      if (u < 0 || v < 0 || w < 0) continue;
      const float z = u * a.z() + v * b.z() + w * c.z();
      if (z > 0) row[x] = std::max(row[x], key_of(z, id));
    }
  }
}

/// A triangle that reaches before the near plane: what is behind it, as a fan. Nothing where a corner is not to be
/// seen.
void fill_clipped(RasterImage& image, const RasterItem& item, std::size_t face, int first_row, int end_row) {
  const auto indices = item.triangles->indices.as<std::uint32_t>();
  const auto positions = (item.rest ? item.points->rest : item.points->positions).as<Eigen::Vector3f>();
  const auto colors = item.points->colors.as<PointColor>();
  Eigen::Vector4f corners[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t i = indices[3 * face + k];
    if ((colors[i].marks & shared::mark_hidden) != 0 || !positions[i].allFinite()) return;
    corners[k] = item.constants.clip * positions[i].homogeneous();
  }
  // Reversed depth: what is not too near has z <= w.
  const auto behind = [](const Eigen::Vector4f& p) { return p.w() - p.z(); };
  std::vector<Eigen::Vector3f> fan;
  const auto add = [&](const Eigen::Vector4f& p) {
    fan.emplace_back((0.5f + 0.5f * p.x() / p.w()) * static_cast<float>(image.width),
                     (0.5f + 0.5f * p.y() / p.w()) * static_cast<float>(image.height), p.z() / p.w());
  };
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector4f &p = corners[k], &q = corners[(k + 1) % 3];
    const float from = behind(p), to = behind(q);
    if (from >= 0) add(p);
    if ((from >= 0) != (to >= 0)) add(p + (q - p) * (from / (from - to)));
  }
  const std::uint32_t id = item.first_id + static_cast<std::uint32_t>(face);
  for (std::size_t k = 2; k < fan.size(); ++k) fill_triangle(image, fan[0], fan[k - 1], fan[k], id, first_row, end_row);
}

void fill_triangles(RasterImage& image, const RasterItem& item, int first_row, int end_row) {
  const auto indices = item.triangles->indices.as<std::uint32_t>();
  const auto low = static_cast<float>(first_row), high = static_cast<float>(end_row);
  for (std::size_t f = 0; f < item.triangles->count; ++f) {
    const Eigen::Vector3f& a = item.projected[indices[3 * f]];
    const Eigen::Vector3f& b = item.projected[indices[3 * f + 1]];
    const Eigen::Vector3f& c = item.projected[indices[3 * f + 2]];
    if (a.z() == 0 || b.z() == 0 || c.z() == 0) {
      fill_clipped(image, item, f, first_row, end_row);
      continue;
    }
    if (std::max({a.y(), b.y(), c.y()}) < low || std::min({a.y(), b.y(), c.y()}) > high) continue;
    fill_triangle(image, a, b, c, item.first_id + static_cast<std::uint32_t>(f), first_row, end_row);
  }
}

RasterItem raster_item(const Scene& scene, const Points& points, VkExtent2D extent, bool rest) {
  RasterItem item;
  item.points = &points;
  item.rest = rest;
  item.count = points.count;
  item.constants = draw_constants(scene, points, extent);
  return item;
}

}  // namespace

float RasterImage::depth(std::size_t pixel) const {
  return std::bit_cast<float>(static_cast<std::uint32_t>(keys[pixel] >> 32));
}

bool can_raster(const Scene& scene) {
  for (const CloudItem& cloud : scene.clouds)
    if (cloud.points->on_device) return false;
  for (const MeshItem& mesh : scene.meshes)
    if (mesh.points->on_device || mesh.triangles->indices.mapped == nullptr) return false;
  return true;
}

std::vector<RasterItem> raster_items(const Scene& scene, VkExtent2D extent, bool ghosts, int scale) {
  std::vector<RasterItem> items;
  std::uint32_t next_id = 1;
  for (const CloudItem& cloud : scene.clouds) {
    if ((cloud.ghost > 0) != ghosts) continue;
    RasterItem item = raster_item(scene, *cloud.points, extent, cloud.rest);
    item.count = std::min(cloud.count, cloud.points->count);
    item.constants = cloud_constants(scene, cloud, extent);
    item.constants.size *= static_cast<float>(scale);
    item.first_id = next_id;
    next_id += static_cast<std::uint32_t>(cloud.points->count);
    items.push_back(std::move(item));
  }
  for (const MeshItem& mesh : scene.meshes) {
    if ((mesh.ghost > 0) != ghosts) continue;
    RasterItem item = raster_item(scene, *mesh.points, extent, mesh.rest);
    item.triangles = mesh.triangles;
    item.constants = mesh_constants(scene, mesh, extent);
    item.first_id = next_id;
    next_id += static_cast<std::uint32_t>(mesh.triangles->count);
    items.push_back(std::move(item));
  }
  return items;
}

void raster(RasterImage& image, int width, int height, std::span<RasterItem> items) {
  image.width = width;
  image.height = height;
  image.keys.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (RasterItem& item : items) project_points(item, width, height);
  // Every band of rows goes through all items, so there are only as many as there are threads to fill, and some more
  // because the shape is rarely spread evenly.
  const int rows = std::max(16, height / (thread_count() > 1 ? 2 * thread_count() : 1) + 1);
  const auto bands = static_cast<std::size_t>((height + rows - 1) / rows);
  parallel_for(bands, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t band = begin; band < end; ++band) {
      const int first = static_cast<int>(band) * rows, last = std::min(height, first + rows);
      const auto stride = static_cast<std::ptrdiff_t>(width);
      std::fill(image.keys.begin() + first * stride, image.keys.begin() + last * stride, 0);
      for (const RasterItem& item : items) {
        if (item.triangles == nullptr)
          splat_points(image, item, first, last);
        else
          fill_triangles(image, item, first, last);
      }
    }
  });
}

}  // namespace sinew::gpu
