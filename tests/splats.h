#pragma once
/// Gaussian splats for tests: shapes with the attributes of a 3DGS file, and what a viewer makes of them, written anew
/// from the definitions.

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "engine/geometry/shape.h"

namespace sinew {

struct RandomSplats {
  std::mt19937 random;
  explicit RandomSplats(unsigned seed = 5) : random(seed) {}

  double value() { return std::uniform_real_distribution<double>(-1, 1)(random); }
  Vec3 vector() { return {value(), value(), value()}; }
  Vec3 direction() {
    for (;;)
      if (const Vec3 v = vector(); v.norm() < 1 && v.norm() > 0.1) return v.normalized();
  }
  Mat3 matrix() { return (Mat3() << vector(), vector(), vector()).finished(); }

  /// Uniformly distributed.
  Mat3 rotation() {
    for (;;) {
      const Eigen::Vector4d q(value(), value(), value(), value());
      if (q.norm() < 1 && q.norm() > 0.1) return matrix_of(q);
    }
  }

  /// Of a quaternion (w, x, y, z) of any norm.
  static Mat3 matrix_of(const Eigen::Vector4d& quaternion) {
    const Eigen::Vector4d q = quaternion / quaternion.norm();
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    Mat3 R;
    R << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
        2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),   //
        2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
    return R;
  }
};

/// Appends an attribute of n zero rows with fields `name`_0 ...
inline Attribute& add_attribute(Shape& shape, const char* name, Kind kind, Type type, int components) {
  Attribute a;
  a.name = name;
  a.kind = kind;
  a.type = type;
  a.components = components;
  for (int c = 0; c < components; ++c) a.fields.push_back(a.name + "_" + std::to_string(c));
  a.values.resize(shape.size() * a.row_size());
  shape.attributes.push_back(std::move(a));
  return shape.attributes.back();
}

/// Gives each point of `shape` the attributes of a splat: rotations with norms other than 1, scales from `size` down to
/// a thousandth of it, and harmonics up to `degree`.
inline void add_splats(Shape& shape, double size, int degree, Type type = Type::Float32) {
  RandomSplats random;
  const int coefficients = (degree + 1) * (degree + 1) - 1;
  add_attribute(shape, "f_dc", Kind::SphericalHarmonics, type, 3);
  add_attribute(shape, "f_rest", Kind::SphericalHarmonics, type, 3 * coefficients);
  add_attribute(shape, "opacity", Kind::Scalar, type, 1);
  add_attribute(shape, "scale", Kind::LogScale, type, 3);
  add_attribute(shape, "rot", Kind::Quaternion, type, 4);
  for (Attribute& a : shape.attributes)
    for (std::size_t i = 0; i < a.count(); ++i)
      for (int c = 0; c < a.components; ++c)
        a.set_number(i, c, a.kind == Kind::LogScale ? std::log(size) + 3.5 * (random.value() - 1) : random.value());
}

/// Covariance of splat i.
inline Mat3 covariance_at(const Shape& shape, std::size_t i) {
  const Attribute &rot = *shape.find("rot"), &scale = *shape.find("scale");
  const Mat3 R = RandomSplats::matrix_of({rot.number(i, 0), rot.number(i, 1), rot.number(i, 2), rot.number(i, 3)});
  Mat3 S = Mat3::Zero();
  for (int k = 0; k < 3; ++k) S += std::exp(2 * scale.number(i, k)) * R.col(k) * R.col(k).transpose();
  return S;
}

/// The 15 functions of bands 1 to 3 of 3D Gaussian splatting, from their polynomials, at the unit vector d.
inline std::array<double, 15> harmonics_at(const Vec3& d) {
  const double x = d.x(), y = d.y(), z = d.z();
  const auto c = [](double numerator, double denominator) {
    return std::sqrt(numerator / (denominator * std::numbers::pi));
  };
  return {-c(3, 4) * y,
          c(3, 4) * z,
          -c(3, 4) * x,
          c(15, 4) * x * y,
          -c(15, 4) * y * z,
          c(5, 16) * (2 * z * z - x * x - y * y),
          -c(15, 4) * x * z,
          c(15, 16) * (x * x - y * y),
          -c(35, 32) * y * (3 * x * x - y * y),
          c(105, 4) * x * y * z,
          -c(21, 32) * y * (4 * z * z - x * x - y * y),
          c(7, 16) * z * (2 * z * z - 3 * x * x - 3 * y * y),
          -c(21, 32) * x * (4 * z * z - x * x - y * y),
          c(105, 16) * z * (x * x - y * y),
          -c(35, 32) * x * (x * x - 3 * y * y)};
}

/// Colour of splat i seen along d, bands 1 and up.
inline Vec3 colour_at(const Shape& shape, std::size_t i, const Vec3& d) {
  const Attribute& rest = *shape.find("f_rest");
  const std::array<double, 15> Y = harmonics_at(d);
  const int count = rest.components / 3;
  Vec3 colour = Vec3::Zero();
  for (int channel = 0; channel < 3; ++channel)
    for (int k = 0; k < count; ++k)
      colour[channel] += rest.number(i, channel * count + k) * Y[static_cast<std::size_t>(k)];
  return colour;
}

}  // namespace sinew
