#include "engine/geometry/shape.h"

#include <cmath>

#include "engine/geometry/bounds.h"

namespace sinew {

Attribute* Shape::find(const std::string& name) {
  for (Attribute& attribute : attributes)
    if (attribute.name == name) return &attribute;
  return nullptr;
}

const Attribute* Shape::find(const std::string& name) const {
  return const_cast<Shape*>(this)->find(name);
}

Vec3 choose_origin(const Vec3& min, const Vec3& max) {
  Vec3 origin = Vec3::Zero();
  for (int c = 0; c < 3; ++c) {
    const double centre = 0.5 * (min[c] + max[c]), extent = max[c] - min[c];
    // Within a quarter of the centre, every x lies in [origin/2, 2 origin]: the difference is exact. Rounding the
    // centre to 20 bits keeps it there and makes the origin a short number to read.
    // Beyond these limits the step would underflow to zero or the rounded centre overflow.
    if (!(std::abs(centre) > 8 * extent) || std::abs(centre) < 1e-300 || std::abs(centre) > 1e300) continue;
    const double step = std::exp2(std::floor(std::log2(std::abs(centre))) - 20);
    origin[c] = std::round(centre / step) * step;
  }
  return origin;
}

void set_origin(Shape& shape) {
  CHECK(shape.origin == Vec3::Zero(), shape.origin.transpose());
  const Bounds bounds = bounds_of(shape.positions);
  if (bounds.empty()) return;
  shape.origin = choose_origin(bounds.min, bounds.max);
  // Exactly: isZero() would take a shape of picometres for one at zero.
  if (shape.origin == Vec3::Zero()) return;
  for (Vec3& p : shape.positions) p -= shape.origin;
}

Sequence still(std::shared_ptr<const Shape> shape) {
  Sequence sequence;
  sequence.load = [shape = std::move(shape)](int) { return shape; };
  return sequence;
}

const char* representation(const Shape& shape) {
  if (!shape.parts.empty()) return "scan set";
  if (!shape.tets.empty()) return "solid mesh";
  if (shape.faces.empty()) return "point cloud";
  std::vector<bool> used(shape.size(), false);
  for (const Index p : shape.faces.points) {
    if (used[p]) return "mesh";
    used[p] = true;
  }
  return "polygon soup";
}

}  // namespace sinew
