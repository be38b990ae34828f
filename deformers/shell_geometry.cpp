#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "deformers/shell_energy.h"

namespace sinew {

namespace {

/// n / |n|^2, with |n| at least `least`; zero where that is not defined.
Vec3 inverse_of(const Vec3& n, double least) {
  const double square = std::max(n.squaredNorm(), least * least);
  return square > 1e-30 ? Vec3(n / square) : Vec3(Vec3::Zero());
}

Mat3 cross_matrix(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

std::vector<ShellEdge> shell_edges(std::span<const Triangle> triangles) {
  struct Side {
    Index low = 0, high = 0, opposite = 0;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t[(k + 2) % 3]});
    }
  std::sort(sides.begin(), sides.end());
  std::vector<ShellEdge> edges;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    // Two triangles over the same three vertices make no angle.
    const bool hinge = end == i + 2 && sides[i].opposite != sides[i + 1].opposite;
    edges.push_back({{sides[i].low, sides[i].high, hinge ? sides[i].opposite : ShellEdge::none,
                      hinge ? sides[i + 1].opposite : ShellEdge::none}});
    i = end;
  }
  return edges;
}

double dihedral_angle(const Vec3& x1, const Vec3& x2, const Vec3& x3, const Vec3& x4) {
  const Vec3 e = x2 - x1, n1 = (x3 - x2).cross(x3 - x1), n2 = (x4 - x1).cross(x4 - x2);
  return std::atan2(n1.cross(n2).dot(e), n1.dot(n2) * e.norm());
}

Hinge hinge_at(const Vec3& x1, const Vec3& x2, const Vec3& x3, const Vec3& x4, std::array<double, 2> least) {
  const Vec3 e = x2 - x1, n1 = (x3 - x2).cross(x3 - x1), n2 = (x4 - x1).cross(x4 - x2);
  const double length = e.norm();
  Hinge out;
  out.theta = std::atan2(n1.cross(n2).dot(e), n1.dot(n2) * length);
  const Vec3 a = inverse_of(n1, least[0]), b = inverse_of(n2, least[1]);
  const Vec3 unit = length > 1e-15 ? Vec3(e / length) : Vec3(Vec3::Zero());
  out.gradient[0] = (x3 - x2).dot(unit) * a + (x4 - x2).dot(unit) * b;
  out.gradient[1] = -(x3 - x1).dot(unit) * a - (x4 - x1).dot(unit) * b;
  out.gradient[2] = length * a;
  out.gradient[3] = length * b;
  return out;
}

double volume_of(std::span<const Vec3> x, std::span<const Triangle> triangles) {
  double sum = 0;
  for (const auto& [i, j, k] : triangles) sum += x[i].cross(x[j]).dot(x[k]);
  return sum / 6;
}

Vec3 ShellTie::at(std::span<const Vec3> x) const {
  const Vec3 &a = x[corners[0]], &b = x[corners[1]], &c = x[corners[2]];
  const Vec3 p = weights[0] * a + weights[1] * b + weights[2] * c;
  return height == 0 ? p : Vec3(p + height * (b - a).cross(c - a).normalized());
}

std::array<Mat3, 3> ShellTie::derivative(std::span<const Vec3> x) const {
  const Vec3 &a = x[corners[0]], &b = x[corners[1]], &c = x[corners[2]];
  const Vec3 N = (b - a).cross(c - a);
  const double length = N.norm();
  Mat3 of_unit = Mat3::Zero();
  if (height != 0 && length > 1e-15)
    of_unit = height / length * (Mat3::Identity() - N * N.transpose() / (length * length));
  return {weights[0] * Mat3::Identity() + of_unit * cross_matrix(c - b),
          weights[1] * Mat3::Identity() + of_unit * cross_matrix(a - c),
          weights[2] * Mat3::Identity() + of_unit * cross_matrix(b - a)};
}

}  // namespace sinew
