#include "apps/samples/implicit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sinew::samples {

Implicit::Implicit(std::vector<Capsule> parts, bool floor) : parts_(std::move(parts)), floor_(floor) {
  for (const Capsule& part : parts_) {
    const double reach = std::max(part.ra, part.rb) + part.blend;
    spheres_.push_back({0.5 * (part.a + part.b), 0.5 * (part.b - part.a).norm() + reach});
    for (const Vec3& end : {part.a, part.b}) {
      bounds_.add(end - Vec3::Constant(reach));
      bounds_.add(end + Vec3::Constant(reach));
    }
  }
  if (floor_) bounds_.min.y() = std::max(bounds_.min.y(), 0.0);
}

Implicit::Parts Implicit::all() const {
  Parts parts(parts_.size());
  std::iota(parts.begin(), parts.end(), 0);
  return parts;
}

Implicit::Parts Implicit::near_ray(const Vec3& origin, const Vec3& direction) const {
  Parts parts;
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    const Vec3 to = spheres_[i].centre - origin;
    const double along = to.dot(direction);
    if (to.squaredNorm() - along * along <= spheres_[i].radius * spheres_[i].radius)
      parts.push_back(static_cast<int>(i));
  }
  return parts;
}

Implicit::Parts Implicit::near_point(const Vec3& p, double radius) const {
  Parts parts;
  for (std::size_t i = 0; i < spheres_.size(); ++i)
    if ((p - spheres_[i].centre).norm() <= spheres_[i].radius + radius) parts.push_back(static_cast<int>(i));
  return parts;
}

double Implicit::distance(const Vec3& p, const Capsule& part) const {
  const double stretch = 1 / part.flat - 1;
  const Vec3 ab = part.b - part.a;
  const Vec3 from_a = p - part.a;
  const Vec3 ap = from_a + stretch * from_a.dot(part.axis) * part.axis;
  const Vec3 axis = ab + stretch * ab.dot(part.axis) * part.axis;
  const double length2 = axis.squaredNorm();
  const double t = length2 > 0 ? std::clamp(ap.dot(axis) / length2, 0.0, 1.0) : 0.0;
  const Vec3 out = ap - t * axis;
  const double length = out.norm();
  const double d = length - (part.ra + t * (part.rb - part.ra));
  if (stretch == 0 || length == 0) return d;
  const double along = out.dot(part.axis) / length;
  return d / std::sqrt(1 + (stretch * stretch + 2 * stretch) * along * along);
}

double Implicit::distance(const Vec3& p, const Parts& parts) const {
  double d = std::numeric_limits<double>::infinity();
  for (const int i : parts) {
    const Capsule& part = parts_[static_cast<std::size_t>(i)];
    const double e = distance(p, part);
    const double apart = std::abs(d - e);
    d = std::min(d, e);
    if (const double k = part.blend; apart < k) {
      const double h = (k - apart) / k;
      d -= h * h * k / 4;
    }
  }
  return floor_ ? std::max(d, -p.y()) : d;
}

Vec3 Implicit::normal(const Vec3& p, const Parts& parts) const {
  constexpr double h = 1e-4;
  Vec3 gradient;
  for (int c = 0; c < 3; ++c) {
    const Vec3 step = h * Vec3::Unit(c);
    gradient[c] = distance(p + step, parts) - distance(p - step, parts);
  }
  const double length = gradient.norm();
  return length > 0 ? Vec3(gradient / length) : Vec3(Vec3::UnitY());
}

int Implicit::material(const Vec3& p, const Parts& parts) const {
  double least = std::numeric_limits<double>::infinity();
  int material = 0;
  for (const int i : parts) {
    const Capsule& part = parts_[static_cast<std::size_t>(i)];
    const double d = distance(p, part);
    if (d < least) {
      least = d;
      material = part.material;
    }
  }
  return material;
}

double Implicit::trace(const Vec3& origin, const Vec3& direction, double near, double far, const Parts& parts) const {
  constexpr double miss = std::numeric_limits<double>::infinity();
  if (parts.empty()) return miss;
  double t = near;
  for (int step = 0; step < 400 && t <= far; ++step) {
    const double d = distance(origin + t * direction, parts);
    if (d < 2e-5) return t;
    t += 0.85 * d;  // a flattened capsule's distance is one only near the surface
  }
  return miss;
}

}  // namespace sinew::samples
