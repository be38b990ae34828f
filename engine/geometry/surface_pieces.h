#pragma once
/// A surface in pieces of about one size, for places spread over it and for the place of it that is nearest to a point.

#include <array>
#include <span>
#include <vector>

#include "engine/geometry/nearest.h"
#include "engine/geometry/shape.h"

namespace sinew {

class SurfacePieces {
 public:
  /// Of the shape's faces, long triangles halved at their longest edge until none is longer than `longest`; of its
  /// points where it has no faces. What is not finite is left out. `longest` above 0.
  SurfacePieces(const Shape& shape, double longest);

  bool empty() const { return pieces_.empty(); }

  /// The place of the surface nearest to p, and the unit normal of the piece it is on (zero where that has none). Looks
  /// at the pieces with the nearest centres: exact where pieces are alike in size around it. Not for an empty one.
  struct Place {
    Vec3 at, normal;
  };
  Place nearest(const Vec3& p) const;

  /// Up to `count` centres of pieces, each the farthest from those before it; the first is the farthest from the mean
  /// of all. Among equals the lowest by x, y, z.
  std::vector<Vec3> spread(std::size_t count) const;

 private:
  using Piece = std::array<Vec3, 3>;
  static std::vector<Piece> pieces_of(const Shape& shape, double longest);
  static std::vector<Vec3> centres_of(std::span<const Piece> pieces);

  std::vector<Piece> pieces_;  ///< ascending by their centres' x, y, z
  NearestTree centres_;
};

}  // namespace sinew
