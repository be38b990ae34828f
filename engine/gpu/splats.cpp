#include "engine/gpu/splats.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/geometry/gaussian.h"
#include "engine/geometry/harmonics.h"
#include "engine/geometry/parallel.h"

namespace sinew::gpu {
namespace {

using Eigen::Vector3f;
using shared::SplatInstance;

constexpr std::size_t block = 4096;  ///< splats of one parallel block

/// The Jacobian is taken at most so far beside the picture (1: its edge): beyond, a perspective's grows without limit.
constexpr float widest = 1.3f;

const Attribute* find_kind(const Shape& shape, Kind kind, int components) {
  for (const Attribute& a : shape.attributes)
    if (a.kind == kind && a.per_point() && a.components == components) return &a;
  return nullptr;
}

const Attribute* find_opacity(const Shape& shape) {
  const Attribute* a = shape.find("opacity");
  return a != nullptr && a->per_point() && a->components == 1 ? a : nullptr;
}

Splats::Covariance covariance_of(const Attribute& rotation, const Attribute& scale, std::size_t i) {
  const Gaussian gaussian{{rotation.number(i, 0), rotation.number(i, 1), rotation.number(i, 2), rotation.number(i, 3)},
                          {scale.number(i, 0), scale.number(i, 1), scale.number(i, 2)}};
  const Eigen::Matrix3f S = covariance(gaussian).cast<float>();
  return {S(0, 0), S(0, 1), S(0, 2), S(1, 1), S(1, 2), S(2, 2)};
}

/// Degree of "f_rest", which has all coefficients but the first of red, then of green, then of blue; 0: it has none.
int degree_of(const Attribute* rest) {
  return rest != nullptr && rest->per_point() ? harmonics_degree(rest->components).value_or(0) : 0;
}

void read_harmonics(const Shape& shape, Splats& out) {
  const Attribute *first = shape.find("f_dc"), *rest = shape.find("f_rest");
  if (first != nullptr && (!first->per_point() || first->components != 3)) first = nullptr;
  out.degree = first != nullptr ? degree_of(rest) : 0;
  const std::size_t coefficients = out.coefficients();
  const int others = static_cast<int>(coefficients) - 1;
  out.harmonics.assign(out.count * coefficients, Vector3f::Constant((200.0f / 255 - 0.5f) / shared::harmonic_0));
  if (first == nullptr) return;
  parallel_for(out.count, block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vector3f* c = out.harmonics.data() + i * coefficients;
      for (int channel = 0; channel < 3; ++channel) {
        c[0][channel] = static_cast<float>(first->number(i, channel));
        for (int k = 0; k < others; ++k) c[k + 1][channel] = static_cast<float>(rest->number(i, channel * others + k));
      }
    }
  });
}

/// A camera as the splats of an item need it: coordinates relative to their centre, pixels of the picture.
struct Projector {
  Eigen::Matrix4f clip;
  Eigen::Vector4f eye;  ///< as DrawConstants::eye
  Eigen::Vector2f size;

  Projector(const Scene& scene, const Splats& splats, VkExtent2D extent)
      : size(static_cast<float>(extent.width), static_cast<float>(extent.height)) {
    const Eigen::Affine3d to_scene(Eigen::Translation3d(splats.centre));
    clip = (clip_matrix(scene.camera, static_cast<double>(extent.width) / extent.height) * to_scene.matrix())
               .cast<float>();
    const Eigen::Vector3d& at = scene.camera.eye;
    if (scene.camera.orthographic)
      eye << (at - scene.camera.target).normalized().cast<float>(), 0;
    else
      eye << (at - splats.centre).cast<float>(), 1;
  }

  /// Depth 0 where it is not seen. Conditions are written so that NaN is not seen either.
  SplatInstance instance(const Splats& splats, std::size_t i) const;
};

SplatInstance Projector::instance(const Splats& splats, std::size_t i) const {
  SplatInstance out;
  out.at.setZero();
  const float opacity = splats.opacities[i];
  const Eigen::Vector4f p = clip * splats.positions[i].homogeneous();
  const float depth = p.z() / p.w();
  if (!(opacity >= shared::splat_least && p.w() > 0 && depth > 0 && depth <= 1)) return out;

  // Rows of J: the derivative of (x / w) by the position, half the picture long.
  const Eigen::Vector2f ndc = p.head<2>() / p.w();
  const Eigen::Vector2f inner = ndc.cwiseMax(-widest).cwiseMin(widest);
  const Eigen::Matrix<float, 2, 3> J =
      (0.5f * size / p.w()).asDiagonal() * (clip.topLeftCorner<2, 3>() - inner * clip.block<1, 3>(3, 0));
  const Splats::Covariance& c = splats.covariances[i];
  Eigen::Matrix3f S;
  S << c.xx, c.xy, c.xz, c.xy, c.yy, c.yz, c.xz, c.yz, c.zz;
  const Eigen::Matrix2f S2 = J * S * J.transpose();
  const float a = S2(0, 0) + shared::splat_low_pass, b = S2(0, 1), d = S2(1, 1) + shared::splat_low_pass;
  const float determinant = a * d - b * b;
  if (!(determinant > 0 && determinant < 1e30f)) return out;

  const float within = std::min(shared::splat_cut, 2 * std::log(opacity / shared::splat_least));
  const Eigen::Vector2f at = (0.5f + 0.5f * ndc.array()) * size.array();
  const Eigen::Vector2f reach = (within * Eigen::Array2f(a, d)).sqrt();
  if (!(((at + reach).array() > 0).all() && ((at - reach).array() < size.array()).all())) return out;
  const Vector3f color = splat_color(splats, i, (eye.w() * splats.positions[i] - eye.head<3>()).normalized());
  if (!color.allFinite()) return out;
  out.at = Vector3f(at.x(), at.y(), depth);
  out.conic = Vector3f(d, -b, a) / determinant;
  out.reach = reach;
  out.color << color, opacity;
  return out;
}

}  // namespace

bool holds_splats(const Shape& shape) {
  return find_kind(shape, Kind::Quaternion, 4) != nullptr && find_kind(shape, Kind::LogScale, 3) != nullptr &&
         find_opacity(shape) != nullptr;
}

Splats create_splats(const Shape& shape) {
  const Attribute *rotation = find_kind(shape, Kind::Quaternion, 4), *scale = find_kind(shape, Kind::LogScale, 3);
  const Attribute* opacity = find_opacity(shape);
  CHECK(rotation != nullptr && scale != nullptr && opacity != nullptr);
  Splats out;
  out.count = shape.size();
  out.positions.resize(out.count);
  out.covariances.resize(out.count);
  out.opacities.resize(out.count);
  const Bounds bounds = bounds_of(shape.positions);
  if (!bounds.empty()) out.centre = bounds.centre();
  parallel_for(out.count, block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      out.positions[i] = (shape.positions[i] - out.centre).cast<float>();
      out.covariances[i] = covariance_of(*rotation, *scale, i);
      out.opacities[i] = static_cast<float>(1 / (1 + std::exp(-opacity->number(i, 0))));
    }
  });
  read_harmonics(shape, out);
  return out;
}

void tint(Splats& splats, std::size_t i, const Vector3f& color, float part) {
  Vector3f* c = splats.harmonics.data() + i * splats.coefficients();
  // Colour is linear in the coefficients, and the first one's harmonic is constant.
  for (std::size_t k = 0; k < splats.coefficients(); ++k)
    c[k] = part < 1 ? Vector3f((1 - part) * c[k]) : Vector3f(0, 0, 0);
  c[0] += part * (color.array() - 0.5f).matrix() / shared::harmonic_0;
}

Vector3f splat_color(const Splats& splats, std::size_t i, const Vector3f& direction) {
  const Vector3f* c = splats.harmonics.data() + i * splats.coefficients();
  const float x = direction.x(), y = direction.y(), z = direction.z();
  Vector3f sum = shared::harmonic_0 * c[0];
  if (splats.degree >= 1) sum += 0.4886025f * (z * c[2] - y * c[1] - x * c[3]);
  const float xx = x * x, yy = y * y, zz = z * z;
  if (splats.degree >= 2)
    sum += 1.0925484f * (x * y * c[4] - y * z * c[5] - x * z * c[7]) + 0.3153916f * (2 * zz - xx - yy) * c[6] +
           0.5462742f * (xx - yy) * c[8];
  if (splats.degree >= 3)
    sum += -0.5900436f * (y * (3 * xx - yy) * c[9] + x * (xx - 3 * yy) * c[15]) + 2.8906114f * x * y * z * c[10] -
           0.4570458f * (4 * zz - xx - yy) * (y * c[11] + x * c[13]) +
           0.3731763f * z * (2 * zz - 3 * xx - 3 * yy) * c[12] + 1.4453057f * z * (xx - yy) * c[14];
  return (sum.array() + 0.5f).max(0);
}

Bounds bulk_bounds(const Splats& splats) {
  constexpr double outside = 0.02;  ///< part of the splats on each side of each axis
  Bounds out;
  std::vector<float> values;
  Eigen::Vector3d low, high;
  for (int c = 0; c < 3; ++c) {
    values.clear();
    for (std::size_t i = 0; i < splats.count; ++i)
      if (splats.positions[i].allFinite()) values.push_back(splats.positions[i][c]);
    if (values.empty()) return out;
    const auto nth = [&](double part) {
      const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
      std::nth_element(values.begin(), at, values.end());
      return static_cast<double>(*at);
    };
    low[c] = nth(outside);
    high[c] = nth(1 - outside);
  }
  out.add(splats.centre + low);
  out.add(splats.centre + high);
  return out;
}

std::vector<SplatInstance> splat_instances(const Scene& scene, VkExtent2D extent) {
  std::size_t count = 0;
  for (const SplatItem& item : scene.splats) count += item.splats->count;
  std::vector<SplatInstance> all(count);
  std::size_t first = 0;
  for (const SplatItem& item : scene.splats) {
    const Projector projector(scene, *item.splats, extent);
    parallel_for(item.splats->count, block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) all[first + i] = projector.instance(*item.splats, i);
    });
    first += item.splats->count;
  }
  // Depth is reversed and positive, so its bits grow as it comes nearer; of equally far ones the order stays.
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < count; ++i)
    if (all[i].at.z() > 0) keys.push_back(std::uint64_t{std::bit_cast<std::uint32_t>(all[i].at.z())} << 32 | i);
  std::sort(keys.begin(), keys.end());
  std::vector<SplatInstance> out(keys.size());
  for (std::size_t k = 0; k < keys.size(); ++k) out[k] = all[keys[k] & 0xffffffffu];
  return out;
}

}  // namespace sinew::gpu
