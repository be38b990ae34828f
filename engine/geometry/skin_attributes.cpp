#include "engine/geometry/skin_attributes.h"

#include <Eigen/LU>
#include <array>
#include <optional>

#include "engine/geometry/gaussian.h"
#include "engine/geometry/harmonics.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/rotation.h"
#include "engine/geometry/skin.h"
#include "engine/geometry/skin_maps.h"

namespace sinew {

namespace {

constexpr std::size_t block = 1024;  ///< values of one parallel block

/// The blended map near the points of one value.
struct LocalMap {
  Mat3 M, J;
  Vec3 t;      ///< p -> M p + t, p with the shape's origin
  Vec3 drift;  ///< how fast the map moves the point
  bool moves = false;
};

class Maps {
 public:
  Maps(const Shape& rest, const SkinWeights& weights, const Pose& pose, const Pose* rate)
      : rest_(rest), weights_(weights), D_(padded(pose, identity_map())) {
    CHECK(weights.size() == rest.size(), weights.size(), rest.size());
    CHECK(weights.gradients.empty() || weights.gradients.size() == weights.influences(), weights.gradients.size());
    CHECK(rate == nullptr || rate->size() == pose.size(), pose.size());
    if (rate != nullptr) rate_ = padded(*rate, Affine::Zero());
  }

  /// Of value i.
  LocalMap near(const Attribute& attribute, std::size_t i) const {
    const std::size_t first = attribute.per_point() ? 0 : attribute.point_offsets[i];
    const std::size_t last = attribute.per_point() ? 1 : attribute.point_offsets[i + 1];
    Padded sum = Padded::Zero();
    Mat3 slope = Mat3::Zero();
    Vec3 drift = Vec3::Zero();
    for (std::size_t k = first; k < last; ++k) {
      const std::size_t point = attribute.per_point() ? i : attribute.points[k];
      sum += blend(weights_, D_, point);
      slope += slope_at(point);
      if (!rate_.empty()) drift += at(blend(weights_, rate_, point), rest_.positions[point]);
    }
    LocalMap map;
    map.moves = last > first && !(sum.isZero(0) && slope.isZero(0) && drift.isZero(0));
    if (!map.moves) return map;
    const auto count = static_cast<double>(last - first);
    map.M = Mat3::Identity() + sum.topLeftCorner<3, 3>() / count;
    map.t = sum.topRightCorner<3, 1>() / count + rest_.origin - map.M * rest_.origin;
    map.J = map.M + slope / count;
    map.drift = drift / count;
    return map;
  }

 private:
  /// What the gradients of the weights add to J.
  Mat3 slope_at(std::size_t i) const {
    Mat3 slope = Mat3::Zero();
    const std::uint64_t begin = weights_.offsets[i], end = weights_.offsets[i + 1];
    if (weights_.gradients.empty() || begin == end) return slope;
    const Vec3& p = rest_.positions[i];
    const Vec3 reference = at(D_[weights_.maps[begin]], p);
    for (std::uint64_t e = begin; e < end; ++e)
      slope += (at(D_[weights_.maps[e]], p) - reference) * weights_.gradients[e].cast<double>().transpose();
    return slope;
  }

  const Shape& rest_;
  const SkinWeights& weights_;
  std::vector<Padded> D_, rate_;
};

/// Calls each(i, map) for the values that move.
template <class Each>
void for_values(const Attribute& attribute, const Maps& maps, const Each& each) {
  parallel_for(attribute.count(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (const LocalMap map = maps.near(attribute, i); map.moves) each(i, map);
  });
}

template <int N>
Eigen::Matrix<double, N, 1> row(const Attribute& attribute, std::size_t i) {
  Eigen::Matrix<double, N, 1> out;
  for (int c = 0; c < N; ++c) out[c] = attribute.number(i, c);
  return out;
}

template <class Values>
void set_row(Attribute& attribute, std::size_t i, const Values& values) {
  for (int c = 0; c < attribute.components; ++c) attribute.set_number(i, c, values[c]);
}

/// A value with three components by itself.
Vec3 bend(Kind kind, const LocalMap& map, const Vec3& value) {
  switch (kind) {
    case Kind::Point: return map.M * value + map.t;
    case Kind::Normal: return skin_normal(map.M, value);
    case Kind::Velocity: return map.J * value + map.drift;
    default: return map.J * value;
  }
}

bool is_triple(const Attribute& attribute) {
  const bool kind = attribute.kind == Kind::Point || attribute.kind == Kind::Vector ||
                    attribute.kind == Kind::Velocity || attribute.kind == Kind::Normal;
  return kind && attribute.components == 3;
}

void bend_triples(const Attribute& in, const Maps& maps, Attribute& out) {
  for_values(in, maps, [&](std::size_t i, const LocalMap& map) {
    const Vec3 value = bend(in.kind, map, row<3>(in, i));
    if (value.allFinite()) set_row(out, i, value);
  });
}

void bend_gaussians(const Attribute& rotations, const Attribute& scales, const Maps& maps, Attribute& out_rotations,
                    Attribute& out_scales) {
  for_values(rotations, maps, [&](std::size_t i, const LocalMap& map) {
    if (map.J == Mat3::Identity() || !map.J.allFinite()) return;  // a translation keeps the bits
    const Gaussian rest{row<4>(rotations, i), row<3>(scales, i)};
    const Gaussian bent = sinew::bent(rest, map.J, nearest_rotation(map.J));
    set_row(out_rotations, i, bent.quaternion);
    set_row(out_scales, i, bent.log_scales);
  });
}

/// Coefficients of bands 1 to `degree` of three channels, channel after channel.
void bend_harmonics(const Attribute& in, int degree, const Maps& maps, Attribute& out) {
  const int count = in.components / 3;
  for_values(in, maps, [&](std::size_t i, const LocalMap& map) {
    if (map.J == Mat3::Identity() || !map.J.allFinite()) return;
    const HarmonicsRotation rotation(nearest_rotation(map.J), degree);
    std::array<double, 15> channel{};
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < count; ++k) channel[static_cast<std::size_t>(k)] = in.number(i, c * count + k);
      rotation.turn({channel.data(), static_cast<std::size_t>(count)});
      for (int k = 0; k < count; ++k) out.set_number(i, c * count + k, channel[static_cast<std::size_t>(k)]);
    }
  });
}

/// A quaternion of n points, w first, and the log-scales that make covariances with it: indices of attributes.
struct Gaussians {
  std::size_t rotations, scales;
};

std::optional<Gaussians> find_gaussians(const Shape& shape) {
  std::optional<std::size_t> rotations, scales;
  for (std::size_t a = 0; a < shape.attributes.size(); ++a) {
    const Attribute& attribute = shape.attributes[a];
    if (!attribute.per_point() || is_integer(attribute.type)) continue;
    if (attribute.kind == Kind::Quaternion && attribute.components == 4 && !rotations) rotations = a;
    if (attribute.kind == Kind::LogScale && attribute.components == 3 && !scales) scales = a;
  }
  if (!rotations || !scales) return std::nullopt;
  return Gaussians{*rotations, *scales};
}

std::optional<int> turning_degree(const Attribute& attribute) {
  if (attribute.kind != Kind::SphericalHarmonics || is_integer(attribute.type)) return std::nullopt;
  return harmonics_degree(attribute.components);
}

}  // namespace

void bend_attributes(const Shape& rest, const SkinWeights& weights, const Pose& pose, const Pose* rate, Shape& out) {
  const Maps maps(rest, weights, pose, rate);
  for (std::size_t a = 0; a < rest.attributes.size(); ++a) {
    const Attribute& attribute = rest.attributes[a];
    if (is_triple(attribute)) bend_triples(attribute, maps, out.attributes[a]);
    if (const auto degree = turning_degree(attribute)) bend_harmonics(attribute, *degree, maps, out.attributes[a]);
  }
  if (const auto splats = find_gaussians(rest))
    bend_gaussians(rest.attributes[splats->rotations], rest.attributes[splats->scales], maps,
                   out.attributes[splats->rotations], out.attributes[splats->scales]);
}

bool needs_gradients(const Shape& shape) {
  for (const Attribute& attribute : shape.attributes) {
    const bool by_derivative = attribute.kind == Kind::Vector || attribute.kind == Kind::Velocity;
    if ((by_derivative && attribute.components == 3) || turning_degree(attribute)) return true;
  }
  return find_gaussians(shape).has_value();
}

std::vector<std::string> not_bent(const Shape& shape) {
  const auto gaussians = find_gaussians(shape);
  std::vector<std::string> out;
  for (std::size_t a = 0; a < shape.attributes.size(); ++a) {
    const Attribute& attribute = shape.attributes[a];
    const std::string name = "\"" + attribute.name + "\" stays as it is: expected ";
    const std::string found = ", found " + std::to_string(attribute.components) + " of " + name_of(attribute.type);
    const bool part = gaussians && (a == gaussians->rotations || a == gaussians->scales);
    switch (attribute.kind) {
      case Kind::Point:
      case Kind::Vector:
      case Kind::Velocity:
      case Kind::Normal:
        if (!is_triple(attribute)) out.push_back(name + "3 components" + found);
        break;
      case Kind::Quaternion:
      case Kind::LogScale:
        if (!part) out.push_back(name + "a quaternion of 4 and log-scales of 3 floats for each point" + found);
        break;
      case Kind::SphericalHarmonics:
        // Three are band 0 of the colour channels, the same from every side.
        if (attribute.components != 3 && !turning_degree(attribute))
          out.push_back(name + "9, 24 or 45 floats, spherical harmonics of bands 1 to 3 in three channels" + found);
        break;
      default: break;
    }
  }
  return out;
}

}  // namespace sinew
