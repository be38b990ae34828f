#pragma once
/// Lays points on a surface by a similarity when nobody says which point belongs where: captured markers on a body.
///
/// It finds s, R, t such that the points q_i = s R p_i + t lie on the surface, by iterated closest points [Besl and
/// McKay, "A Method for Registration of 3-D Shapes", PAMI 1992] from many starts, in two stages:
/// - coarse, from the 24 turns of a cube, the same and then by 45 degrees about each axis, and the 24 pairings of
///   principal axes, each with centroids and with boxes on top of each other: least squares of pairs [Umeyama,
///   "Least-Squares Estimation of Transformation Parameters Between Two Point Patterns", PAMI 1991], where each point
///   is paired with the nearest of 600 places that are spread over the surface, and each such place with the nearest
///   point; points and places weigh the same in sum. The second sort of pairs is what keeps s from going to 0.
/// - fine, of the best few: Gauss-Newton with damping on sum_i rho(d_i), d_i = |q_i - c_i|, c_i the place of the
/// surface
///   that is nearest to q_i and rho(d) = d^2 / (1 + d^2 / delta^2) [Geman and McClure 1987], delta = 0.02 diagonals of
///   the surface's box, so that a few points that are not on the surface do not pull; steps see the distance along q_i
///   - c_i alone [Chen and Medioni, "Object Modelling by Registration of Multiple Range Images", 1992].
/// Of these it takes the one where the root of sum_i rho(d_i) times the root of the mean squared distance of pairs is
/// least. The result does not depend on the order of points or faces (but for rounding), nor on the number of threads.

#include <optional>
#include <span>

#include "engine/geometry/shape.h"

namespace sinew {

/// p -> scale R p + t
struct Similarity {
  double scale = 1;
  Mat3 R = Mat3::Identity();
  Vec3 t = Vec3::Zero();
  Vec3 operator()(const Vec3& p) const { return scale * (R * p) + t; }
};

struct SurfaceFit {
  Similarity map;
  /// How large a share of the laid points is within delta of the surface, and their distances from it, in diagonals of
  /// its box.
  double near = 0, rms = 0, max = 0;
};

/// `points` finite, not all on a line; `surface` has a point at least, and where it has no faces its points are the
/// surface. With `scale` that is kept. Relative to the surface's origin. None where the points lie on a line or the
/// surface has no extent.
std::optional<SurfaceFit> fit_to_surface(std::span<const Vec3> points, const Shape& surface,
                                         std::optional<double> scale);

}  // namespace sinew
