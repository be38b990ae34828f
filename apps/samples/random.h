#pragma once
/// Random: numbers that are functions of up to three keys (engine/geometry/random.h), uniform and normal.

#include <cstdint>

#include "engine/geometry/random.h"

namespace sinew::samples {

/// The numbers that belong to up to three keys.
class Random {
 public:
  explicit Random(std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0) : key_(mixed(mixed(mixed(a) ^ b) ^ c)) {}

  /// Number i in [0, 1), of 53 bits.
  double uniform(std::uint64_t i) const { return static_cast<double>(mixed(key_ ^ i) >> 11) * 0x1p-53; }
  /// Number i of mean 0 and deviation 1: a sum of four uniform ones, within [-3.5, 3.5]. (No logarithm or cosine: their
  /// last bits differ between mathematical libraries.)
  double normal(std::uint64_t i) const {
    const double sum = uniform(4 * i) + uniform(4 * i + 1) + uniform(4 * i + 2) + uniform(4 * i + 3);
    return (sum - 2) * 1.7320508075688772;
  }

 private:
  std::uint64_t key_;
};

}  // namespace sinew::samples
