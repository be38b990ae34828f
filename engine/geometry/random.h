#pragma once
/// Random numbers without a state: a number is a function of its keys alone, so that neither the order of calls nor the
/// number of threads changes it.

#include <cstdint>

namespace sinew {

/// All bits of x mixed: the step of SplitMix64 [Steele, Lea, Flood 2014].
inline std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// The i-th number of the stream `seed`: 64 bits.
inline std::uint64_t random_bits(std::uint64_t seed, std::uint64_t i) {
  return mixed(seed * 0x9e3779b97f4a7c15u + i * 0xd1342543de82ef95u);
}

/// The same in [0, 1), of 53 bits.
inline double random_unit(std::uint64_t seed, std::uint64_t i) {
  return static_cast<double>(random_bits(seed, i) >> 11) * 0x1p-53;
}

}  // namespace sinew
