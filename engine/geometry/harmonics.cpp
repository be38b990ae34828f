#include "engine/geometry/harmonics.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace sinew {

namespace {

/// Coefficients u, v, w of table 1 for the element (m, n) of band l.
struct Factors {
  double u = 0, v = 0, w = 0;
};

Factors factors_of(int l, int m, int n) {
  const int a = std::abs(m);
  const double zero = m == 0 ? 1 : 0;
  const double d = std::abs(n) == l ? 2.0 * l * (2 * l - 1) : (l + n) * (l - n);
  return {std::sqrt((l + m) * (l - m) / d), 0.5 * std::sqrt((1 + zero) * (l + a - 1) * (l + a) / d) * (1 - 2 * zero),
          -0.5 * std::sqrt((l - a - 1) * (l - a) / d) * (1 - zero)};
}

/// Those of bands 0 to 3, element after element.
const std::array<std::vector<Factors>, 4>& factors() {
  static const auto all = [] {
    std::array<std::vector<Factors>, 4> table;
    for (int l = 2; l < 4; ++l)
      for (int m = -l; m <= l; ++m)
        for (int n = -l; n <= l; ++n) table[static_cast<std::size_t>(l)].push_back(factors_of(l, m, n));
    return table;
  }();
  return all;
}

/// Band l from band 1 and the one below, m and n from -l to l.
template <class Band>
struct Recursion {
  const Band& one;
  const Band& below;
  int l;

  double r(int i, int j) const { return one(i + 1, j + 1); }
  double R(int a, int b) const { return below(a + l - 1, b + l - 1); }

  double P(int i, int a, int n) const {
    if (n == l) return r(i, 1) * R(a, l - 1) - r(i, -1) * R(a, 1 - l);
    if (n == -l) return r(i, 1) * R(a, 1 - l) + r(i, -1) * R(a, l - 1);
    return r(i, 0) * R(a, n);
  }
  double U(int m, int n) const { return P(0, m, n); }
  double V(int m, int n) const {
    if (m == 0) return P(1, 1, n) + P(-1, -1, n);
    if (m == 1) return P(1, 0, n) * std::numbers::sqrt2;
    if (m == -1) return P(-1, 0, n) * std::numbers::sqrt2;
    return m > 0 ? P(1, m - 1, n) - P(-1, 1 - m, n) : P(1, m + 1, n) + P(-1, -m - 1, n);
  }
  double W(int m, int n) const { return m > 0 ? P(1, m + 1, n) + P(-1, -m - 1, n) : P(1, m - 1, n) - P(-1, 1 - m, n); }
};

}  // namespace

std::optional<int> harmonics_degree(int values) {
  for (int degree = 1; degree <= 3; ++degree)
    if (values == 3 * ((degree + 1) * (degree + 1) - 1)) return degree;
  return std::nullopt;
}

HarmonicsRotation::HarmonicsRotation(const Mat3& Q, int degree) : degree_(degree) {
  CHECK(degree >= 1 && degree <= 3, degree);
  constexpr std::array<int, 3> axis{1, 2, 0};  // m = -1, 0, 1 are y, z, x
  for (int m = 0; m < 3; ++m)
    for (int n = 0; n < 3; ++n) D_[1](m, n) = Q(axis[static_cast<std::size_t>(m)], axis[static_cast<std::size_t>(n)]);
  for (int l = 2; l <= degree; ++l) {
    const auto band = static_cast<std::size_t>(l);
    const Recursion<Band> from{D_[1], D_[band - 1], l};
    const Factors* f = factors()[band].data();
    for (int m = -l; m <= l; ++m)
      for (int n = -l; n <= l; ++n, ++f) {
        double sum = 0;  // a factor of zero stands before elements that do not exist
        if (f->u != 0) sum += f->u * from.U(m, n);
        if (f->v != 0) sum += f->v * from.V(m, n);
        if (f->w != 0) sum += f->w * from.W(m, n);
        D_[band](m + l, n + l) = sum;
      }
  }
}

void HarmonicsRotation::turn(std::span<double> coefficients) const {
  CHECK(static_cast<int>(coefficients.size()) == (degree_ + 1) * (degree_ + 1) - 1, coefficients.size(), degree_);
  double* c = coefficients.data();
  for (int l = 1; l <= degree_; ++l) {
    const int width = 2 * l + 1;
    // (-1)^m before and after. With k = m + l, (-1)^(k + k') is the same.
    std::array<double, 7> turned{};
    for (int m = 0; m < width; ++m)
      for (int n = 0; n < width; ++n)
        turned[static_cast<std::size_t>(m)] +=
            D_[static_cast<std::size_t>(l)](m, n) * ((m + n) % 2 == 0 ? c[n] : -c[n]);
    for (int m = 0; m < width; ++m) c[m] = turned[static_cast<std::size_t>(m)];
    c += width;
  }
}

}  // namespace sinew
