#pragma once
/// Cuts as obstacles: whether the way between two points is barred [Sumner et al. 2007, section 6: the user draws a
/// stroke between parts to "cut" undesired connections].

#include <vector>

#include "engine/geometry/deformer.h"

namespace sinew {

/// The curtain of a cut (deformer.h) is one parallelogram for each two neighbours a, b of its path:
///   a + u (b - a) + v depth,   u, v in [0, 1], the border included
/// A segment p q crosses it where p and q lie on different sides of its plane and the segment meets it inside. A point
/// in the plane itself counts to the side that (b - a) x depth points to, so a curtain through a point never bars it
/// from both sides. Parallelograms without an area bar nothing.
class Curtains {
 public:
  Curtains() = default;
  /// Throws InputError where a cut has a number that is not finite.
  explicit Curtains(std::span<const Cut> cuts);

  bool empty() const { return quads_.empty(); }
  /// The segment from p to q crosses a curtain.
  bool part(const Vec3& p, const Vec3& q) const;

 private:
  struct Quad {
    Vec3 a, normal;  ///< corner, (b - a) x depth
    Vec3 u, v;       ///< x -> u.(x - a), v.(x - a): coordinates in the plane
    Vec3 min, max;
  };
  std::vector<Quad> quads_;
};

}  // namespace sinew
