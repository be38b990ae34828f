#pragma once
/// Cosine and sine that have the same bits with any mathematical library: by their series.

#include <cmath>
#include <numbers>

namespace sinew::samples {

struct CosSin {
  double cos = 1, sin = 0;
};

/// Of an angle in turns (1 is 360 degrees), within 1e-13.
inline CosSin cos_sin(double turns) {
  const double angle = 2 * std::numbers::pi * (turns - std::round(turns));
  CosSin sum{0, 0};
  double term = 1;
  for (int k = 0; k < 28; k += 2) {
    const double next = term * angle / (k + 1);
    sum.cos += k % 4 == 0 ? term : -term;
    sum.sin += k % 4 == 0 ? next : -next;
    term = next * angle / (k + 2);
  }
  return sum;
}

}  // namespace sinew::samples
