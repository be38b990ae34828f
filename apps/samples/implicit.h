#pragma once
/// Implicit: a closed surface as the zero set of a smooth union of flattened, tapered capsules. Negative inside.
///
///   capsule    d(p) = |q - c(q)| - r(q), c the nearest point of the segment a b, r linear from ra to rb; q is p
///   stretched
///              by 1/flat along `axis`, and d is divided by its gradient's length, so it is a distance near the surface
///   union      of distances d, e with radius k: min(d, e) - h^2 k / 4, h = max(k - |d - e|, 0) / k, part after part
///
/// Only sums, products and square roots are used, so that a value has the same bits with any mathematical library.

#include <span>
#include <vector>

#include "engine/geometry/bounds.h"
#include "engine/geometry/shape.h"

namespace sinew::samples {

struct Capsule {
  Vec3 a, b;                  ///< ends of the axis
  double ra = 0, rb = 0;      ///< radii at a and b
  double blend = 0.02;        ///< k of the union with the parts before it
  Vec3 axis = Vec3::UnitZ();  ///< flattened along this unit vector
  double flat = 1;            ///< to this part of its thickness, in (0, 1]
  int material = 0;           ///< what the surface there is made of; its meaning is the user's
};

class Implicit {
 public:
  /// `floor`: nothing below y = 0.
  explicit Implicit(std::vector<Capsule> parts, bool floor = false);

  const Bounds& bounds() const { return bounds_; }  ///< encloses the surface

  /// A list of parts; evaluating with those near the place gives the same surface, quicker.
  using Parts = std::vector<int>;
  Parts all() const;
  Parts near_ray(const Vec3& origin, const Vec3& direction) const;
  Parts near_point(const Vec3& p, double radius) const;

  double distance(const Vec3& p, const Parts& parts) const;
  Vec3 normal(const Vec3& p, const Parts& parts) const;   ///< unit gradient, by central differences
  int material(const Vec3& p, const Parts& parts) const;  ///< of the part whose own distance is the least

  /// Where the ray origin + t direction (unit) first meets the surface for t in [near, far]; infinity where it does
  /// not.
  double trace(const Vec3& origin, const Vec3& direction, double near, double far, const Parts& parts) const;

 private:
  struct Sphere {
    Vec3 centre;
    double radius;
  };
  double distance(const Vec3& p, const Capsule& part) const;

  std::vector<Capsule> parts_;
  std::vector<Sphere> spheres_;  ///< around each part and what its union may add
  bool floor_;
  Bounds bounds_;
};

}  // namespace sinew::samples
