#pragma once
/// Counter-based random numbers: the i-th number of a stream is a function of (seed, i) alone, so no order or thread
/// matters.

#include <cstdint>

namespace sinew {

/// 64 well-mixed bits [Steele, Lea, Flood 2014: the finalizer of SplitMix64].
inline std::uint64_t random_bits(std::uint64_t seed, std::uint64_t i) {
  std::uint64_t z = (seed + 1) * 0x9e3779b97f4a7c15u + i * 0xd1342543de82ef95u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// In [0, 1).
inline double random_unit(std::uint64_t seed, std::uint64_t i) {
  return static_cast<double>(random_bits(seed, i) >> 11) * 0x1p-53;
}

}  // namespace sinew
