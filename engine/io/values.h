#pragma once
/// Values of the ten attribute types as a file has them: loading and storing at any byte, either endianness.

#include <bit>
#include <cmath>

#include "engine/geometry/attribute.h"
#include "engine/io/bytes.h"

namespace sinew::io {

/// Native value of the bytes at `at`; `swap` where the file's byte order is not this machine's.
template <class T>
T load(const std::byte* at, bool swap) {
  T x;
  std::memcpy(&x, at, sizeof(T));
  return swap ? swapped(x) : x;
}

template <class T>
void store(std::byte* at, T x, bool swap) {
  if (swap) x = swapped(x);
  std::memcpy(at, &x, sizeof(T));
}

/// True where a coordinate is still the one that was read: `now` is relative to `origin`, `file` is the file's. The
/// same subtraction as set_origin's, so that it holds for coordinates far outside the bounds too.
inline bool same_coordinate(double file, double origin, double now) {
  return now == file - origin || now + origin == file || (std::isnan(now) && std::isnan(file));
}

}  // namespace sinew::io
