#pragma once
/// Rotation of real spherical harmonics: of the colours that a Gaussian shows in each direction.
///
///   colour(d) = sum_l sum_m c_lm Y_lm(d),  d a unit vector;   c'_l = D_l(Q) c_l  gives  colour'(Q d) = colour(d)
///
/// D_l, (2l+1) x (2l+1), comes from D_1 and D_(l-1) by the recursion of [Ivanic and Ruedenberg: Rotation Matrices for
/// Real Spherical Harmonics, J. Phys. Chem. 100, 1996, table 2, with the corrections of vol. 102, 1998].
///
/// Order and signs are those of 3D Gaussian splatting: band after band, m from -l to l, Y_lm with the factor (-1)^m
/// that the recursion's have not (so band 1 is -y, z, -x).

#include <array>
#include <optional>
#include <span>

#include "engine/geometry/shape.h"

namespace sinew {

/// The highest band where a channel has the coefficients of bands 1 up to it, and there are three channels: 9, 24 and
/// 45 values are 1, 2 and 3; no other count has one.
std::optional<int> harmonics_degree(int values);

class HarmonicsRotation {
 public:
  /// Q: a rotation. degree: 1, 2 or 3.
  HarmonicsRotation(const Mat3& Q, int degree);

  /// Turns the coefficients of bands 1 to `degree` of one channel: 3, 8 or 15.
  void turn(std::span<double> coefficients) const;

 private:
  using Band = Eigen::Matrix<double, 7, 7>;  ///< of which the upper left (2l+1) x (2l+1) is used
  int degree_;
  std::array<Band, 4> D_;
};

}  // namespace sinew
