#include "engine/gpu/raster_surface.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace sinew::gpu {
namespace {

using Eigen::Vector3f;
using shared::DrawConstants;

/// What surface.glsl does.
Vector3f to_eye(const DrawConstants& c, const Vector3f& position) {
  return (c.eye.head<3>() - c.eye.w() * position).normalized();
}

float light_on(const DrawConstants& c, const Vector3f& normal, const Vector3f& eye) {
  const float sky = (c.flags & shared::draw_z_up) != 0 ? normal.z() : normal.y();
  return shared::surface_light(normal.dot(c.light), sky, normal.dot(eye));
}

Vector3f tinted(const DrawConstants& c, const PointColor& color) {
  Vector3f out(color.r / 255.0f, color.g / 255.0f, color.b / 255.0f);
  for (std::uint32_t k = 0; k < 3; ++k)
    if ((color.marks >> k & 1) != 0) out += shared::mark_strength * (color_of(c.mark_colors[k]) - out);
  return out;
}

Shaded shade_point(const RasterItem& item, std::size_t i) {
  const DrawConstants& c = item.constants;
  if ((c.flags & shared::draw_ghost) != 0)
    return {color_of(c.ghost_color), false, static_cast<float>(c.ghost_color >> 24) / 255.0f};
  const PointColor& color = item.points->colors.as<PointColor>()[i];
  float light = shared::unlit;
  if ((c.flags & shared::draw_normals) != 0) {
    const Vector3f normal = (item.rest ? item.points->rest_normals : item.points->normals).as<Vector3f>()[i];
    const Vector3f eye = to_eye(c, (item.rest ? item.points->rest : item.points->positions).as<Vector3f>()[i]);
    light = light_on(c, normal.dot(eye) < 0 ? Vector3f(-normal) : normal, eye);
  }
  return {tinted(c, color) * light, (color.marks & shared::mark_selected) != 0};
}

/// The same for a triangle with a corner that has no place on the screen: in homogeneous coordinates, sum b_i (x_i,
/// y_i, w_i) = (x, y, 1), and the weights are b [Olano and Greer 1997].
Vector3f clipped_weights(const RasterItem& item, const std::uint32_t* corners, const Vector3f& ndc) {
  const auto positions = (item.rest ? item.points->rest : item.points->positions).as<Vector3f>();
  Eigen::Matrix3d M;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector4f p = item.constants.clip * positions[corners[k]].homogeneous();
    M.col(k) = Eigen::Vector3d(p.x(), p.y(), p.w());
  }
  const Eigen::Vector3d b = M.inverse() * ndc.cast<double>();
  return (b / b.sum()).cast<float>();
}

/// Weights of the corners at a pixel's centre, corrected for perspective (depth is one over the distance there).
Vector3f corner_weights(const RasterItem& item, const std::uint32_t* corners, float x, float y) {
  const Vector3f &a = item.projected[corners[0]], &b = item.projected[corners[1]], &c = item.projected[corners[2]];
  const float ux = b.x() - a.x(), uy = b.y() - a.y(), vx = c.x() - a.x(), vy = c.y() - a.y();
  const float inverse = 1 / (ux * vy - uy * vx);
  const float v = ((x - a.x()) * vy - (y - a.y()) * vx) * inverse;
  const float w = (ux * (y - a.y()) - uy * (x - a.x())) * inverse;
  Vector3f weights(1 - v - w, v, w);
  if (item.constants.eye.w() > 0) weights = weights.cwiseProduct(Vector3f(a.z(), b.z(), c.z()));
  return weights / weights.sum();
}

/// `at`: the pixel's centre; `ndc`: the same from -1 to 1, and 1.
Shaded shade_face(const RasterItem& item, std::size_t face, const Eigen::Vector2f& at, const Vector3f& ndc) {
  const DrawConstants& c = item.constants;
  const std::uint32_t* corners = item.triangles->indices.as<std::uint32_t>().data() + 3 * face;
  const bool clipped =
      item.projected[corners[0]].z() == 0 || item.projected[corners[1]].z() == 0 || item.projected[corners[2]].z() == 0;
  const Vector3f weights =
      clipped ? clipped_weights(item, corners, ndc) : corner_weights(item, corners, at.x(), at.y());
  const auto positions = (item.rest ? item.points->rest : item.points->positions).as<Vector3f>();
  const auto colors = item.points->colors.as<PointColor>();
  const Vector3f &p0 = positions[corners[0]], &p1 = positions[corners[1]], &p2 = positions[corners[2]];
  const Vector3f eye = to_eye(c, weights[0] * p0 + weights[1] * p1 + weights[2] * p2);
  Vector3f n = (p1 - p0).cross(p2 - p0).normalized();
  if (n.dot(eye) < 0) n = -n;
  Vector3f color(0, 0, 0), smooth(0, 0, 0);
  float selected = 0;
  for (int k = 0; k < 3; ++k) {
    color += weights[k] * tinted(c, colors[corners[k]]);
    selected += (colors[corners[k]].marks & shared::mark_selected) != 0 ? weights[k] : 0;
  }
  if ((c.flags & shared::draw_flat) == 0) {
    const auto normals = (item.rest ? item.points->rest_normals : item.points->normals).as<Vector3f>();
    for (int k = 0; k < 3; ++k) smooth += weights[k] * normals[corners[k]];
    if (smooth.squaredNorm() > 0) n = smooth.dot(n) < 0 ? Vector3f(-smooth.normalized()) : smooth.normalized();
  }
  if ((c.flags & shared::draw_ghost) != 0) {
    const float rim = 1 - std::abs(n.dot(eye));
    return {color_of(c.ghost_color), false,
            static_cast<float>(c.ghost_color >> 24) / 255.0f * (0.25f + 0.75f * rim * rim)};
  }
  return {color * light_on(c, n, eye), selected > 0.5f};
}

}  // namespace

Eigen::Vector3f color_of(std::uint32_t rgba) {
  return Vector3f(static_cast<float>(rgba & 255), static_cast<float>(rgba >> 8 & 255),
                  static_cast<float>(rgba >> 16 & 255)) /
         255.0f;
}

Shaded shade(std::span<const RasterItem> items, const RasterImage& image, std::size_t pixel) {
  const std::uint32_t id = image.id(pixel);
  std::size_t k = items.size() - 1;
  while (items[k].first_id > id) --k;
  const std::size_t element = id - items[k].first_id;
  if (items[k].triangles == nullptr) return shade_point(items[k], element);
  const auto width = static_cast<std::size_t>(image.width);
  const std::size_t column = pixel % width, row = pixel / width;
  const Eigen::Vector2f at(static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f);
  const Vector3f ndc(2 * at.x() / static_cast<float>(image.width) - 1,
                     2 * at.y() / static_cast<float>(image.height) - 1, 1);
  return shade_face(items[k], element, at, ndc);
}

}  // namespace sinew::gpu
