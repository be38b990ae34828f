#pragma once
/// A task's share of an output that several tasks write together.

#include <cstdint>

namespace sinew::io {

/// Task `index` of `count`. The shares of n things tile them in order, and their sizes differ by one at most.
struct Share {
  std::uint64_t index = 1;  ///< 1..count
  std::uint64_t count = 1;  ///< to 2^32

  /// The task's things are [first, last) of n.
  std::uint64_t first(std::uint64_t n) const { return part(n, index - 1); }
  std::uint64_t last(std::uint64_t n) const { return part(n, index); }

 private:
  /// n i / count, of which no part overflows.
  std::uint64_t part(std::uint64_t n, std::uint64_t i) const { return n / count * i + n % count * i / count; }
};

}  // namespace sinew::io
