#pragma once
/// Coordinates of moved points in the type that a binary file has, and what that rounds away.

#include <cmath>

#include "engine/io/io.h"
#include "engine/io/text_patch.h"
#include "engine/io/values.h"

namespace sinew::io {

/// Says once how much was lost where values far from zero were rounded to the file's type.
class Rounding {
 public:
  void see(double wanted, double stored) {
    if (std::isfinite(wanted)) worst_ = std::max(worst_, std::abs(wanted - stored));
  }
  void report(WriteReport& report) const {
    if (worst_ > 0.5e-3)
      report.lost.push_back("The file's type of coordinates rounds moved points by up to " +
                            shortest(static_cast<float>(worst_)) + ".");
  }

 private:
  double worst_ = 0;
};

/// Replaces the coordinate of type T at `at` where it is not `now` + `origin` any more.
template <class T>
void patch_coordinate(std::byte* at, bool swap, double now, double origin, Rounding& rounding) {
  if (same_coordinate(static_cast<double>(load<T>(at, swap)), origin, now)) return;
  const double wanted = now + origin;
  const T stored = rounded<T>(wanted);
  if (!std::is_same_v<T, float> || std::abs(wanted) >= float_limit) rounding.see(wanted, static_cast<double>(stored));
  store(at, stored, swap);
}

}  // namespace sinew::io
