#include "deformers/rotation_lanes.h"

#include <cmath>

#include "engine/geometry/rotation.h"

namespace sinew {

namespace {

/// A' B.
Mat3Lanes transposed_times(const Mat3Lanes& A, const Mat3Lanes& B) {
  Mat3Lanes out;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t r = 0; r < 3; ++r)
      out[3 * c + r] = A[3 * r] * B[3 * c] + A[3 * r + 1] * B[3 * c + 1] + A[3 * r + 2] * B[3 * c + 2];
  return out;
}

/// A B.
Mat3Lanes times(const Mat3Lanes& A, const Mat3Lanes& B) {
  Mat3Lanes out;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t r = 0; r < 3; ++r)
      out[3 * c + r] = A[r] * B[3 * c] + A[3 + r] * B[3 * c + 1] + A[6 + r] * B[3 * c + 2];
  return out;
}

/// N(M), whose largest eigenvector (w, x, y, z) is the rotation nearest to M: rows 0 to 3 of the upper triangle.
struct Horn {
  Lanes a, b, c, d, e, f, g, h, i, j;  // [a b c d; . e f g; . . h i; . . . j]
  explicit Horn(const Mat3Lanes& M) {
    const Lanes xx = M[0], yx = M[1], zx = M[2], xy = M[3], yy = M[4], zy = M[5], xz = M[6], yz = M[7], zz = M[8];
    a = xx + yy + zz;
    b = zy - yz;
    c = xz - zx;
    d = yx - xy;
    e = xx - yy - zz;
    f = xy + yx;
    g = xz + zx;
    h = yy - xx - zz;
    i = yz + zy;
    j = zz - xx - yy;
  }
};

/// First column of the adjugate of N - s: the eigenvector, times its own first component.
void eigenvector(const Horn& N, Lanes s, Lanes& w, Lanes& x, Lanes& y, Lanes& z) {
  const Lanes e = N.e - s, h = N.h - s, j = N.j - s;
  const Lanes hj = h * j - N.i * N.i, fi_gh = N.f * N.i - N.g * h, fj_gi = N.f * j - N.g * N.i;
  const Lanes eh = e * h - N.f * N.f, ei = e * N.i - N.f * N.g, ej = e * j - N.g * N.g;
  w = e * hj - N.f * fj_gi + N.g * fi_gh;
  x = -(N.b * hj - N.c * fj_gi + N.d * fi_gh);
  y = N.b * fj_gi - N.c * ej + N.d * ei;
  z = -(N.b * fi_gh - N.c * ei + N.d * eh);
}

Mat3Lanes rotation_of(Lanes w, Lanes x, Lanes y, Lanes z, Lanes squares) {
  const Lanes t = 2.0 / squares;
  return {1.0 - t * (y * y + z * z), t * (x * y + w * z),       t * (x * z - w * y),
          t * (x * y - w * z),       1.0 - t * (x * x + z * z), t * (y * z + w * x),
          t * (x * z + w * y),       t * (y * z - w * x),       1.0 - t * (x * x + y * y)};
}

using Truths = decltype(Lanes{} < Lanes{});

bool all_of(Truths truths) {
  auto all = truths[0];
  for (std::size_t l = 1; l < lane_count; ++l) all &= truths[l];
  return all != 0;
}

Lanes magnitude(Lanes x) {
  return x < 0.0 ? -x : x;
}

/// The lane's rotation by singular values, and where these leave a choice, unchanged.
void one_by_one(const Mat3Lanes& M, Mat3Lanes& R, std::size_t lane) {
  Mat3 m;
  for (std::size_t k = 0; k < 9; ++k) m.data()[k] = M[k][lane];
  if (!(m.squaredNorm() > 0)) return;
  const Mat3 r = nearest_rotation(m);
  for (std::size_t k = 0; k < 9; ++k) R[k][lane] = r.data()[k];
}

}  // namespace

void nearest_rotations(const Mat3Lanes& M, Mat3Lanes& R) {
  // Of the turn since the last R: it is small nearly always, its quaternion near (1, 0, 0, 0), and nothing cancels.
  const Mat3Lanes turn = transposed_times(R, M);
  const Horn N(turn);
  Lanes squares = {};
  for (const Lanes& m : turn) squares += m * m;
  const Lanes determinant = turn[0] * (turn[4] * turn[8] - turn[5] * turn[7]) -
                            turn[3] * (turn[1] * turn[8] - turn[2] * turn[7]) +
                            turn[6] * (turn[1] * turn[5] - turn[2] * turn[4]);
  // p(s) = s^4 - 2 |M|^2 s^2 - 8 det(M) s + det(N)
  const Lanes s01 = N.a * N.e - N.b * N.b, s02 = N.a * N.f - N.b * N.c, s03 = N.a * N.g - N.b * N.d;
  const Lanes s12 = N.b * N.f - N.c * N.e, s13 = N.b * N.g - N.d * N.e, s23 = N.c * N.g - N.d * N.f;
  const Lanes c01 = N.h * N.j - N.i * N.i, c02 = N.f * N.j - N.g * N.i, c03 = N.f * N.i - N.g * N.h;
  const Lanes c12 = N.c * N.j - N.d * N.i, c13 = N.c * N.i - N.d * N.h, c23 = N.c * N.g - N.d * N.f;
  const Lanes det_N = s01 * c01 - s02 * c02 + s03 * c03 + s12 * c12 - s13 * c13 + s23 * c23;
  Lanes s;
  for (std::size_t l = 0; l < lane_count; ++l) s[l] = std::sqrt(3 * squares[l]);  // not below the largest root
  Lanes slope = {}, change = {};
  for (int step = 0; step < 6; ++step) {
    const Lanes p = ((s * s - 2.0 * squares) * s - 8.0 * determinant) * s + det_N;
    slope = 4.0 * (s * s - squares) * s - 8.0 * determinant;
    change = p / slope;
    s -= change;
    // Quadratic convergence: what is left is about the square of this. The turn is small nearly always, so is the way.
    if (step > 0 && all_of(magnitude(change) < 1e-10 * s)) break;
  }
  Lanes w, x, y, z;
  eigenvector(N, s, w, x, y, z);
  const Lanes norm = w * w + x * x + y * y + z * z;
  const Mat3Lanes turned = rotation_of(w, x, y, z, norm);
  const Mat3Lanes out = times(R, turned);
  // Where the root is nearly a double one, the turn is far, or the iteration is not at its end, in full.
  const Truths good = (slope > 1e-4 * squares * s) & (w * w > 0.1 * norm) & (magnitude(change) < 1e-9 * s);
  if (all_of(good)) {
    R = out;
    return;
  }
  Mat3Lanes in_full = R;
  for (std::size_t l = 0; l < lane_count; ++l)
    if (good[l])
      for (std::size_t k = 0; k < 9; ++k) in_full[k][l] = out[k][l];
    else
      one_by_one(M, in_full, l);
  R = in_full;
}

}  // namespace sinew
