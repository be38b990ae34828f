#pragma once
/// Values of the ten attribute types as a file has them: dispatch on the type, loading and storing at any byte, either
/// endianness, and rounding of a double to the type.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "engine/geometry/attribute.h"
#include "engine/io/bytes.h"

namespace sinew::io {

/// Calls f with a value of the C++ type that `type` names.
template <class F>
auto with_type(Type type, F&& f) {
  switch (type) {
    case Type::Int8: return f(std::int8_t{});
    case Type::UInt8: return f(std::uint8_t{});
    case Type::Int16: return f(std::int16_t{});
    case Type::UInt16: return f(std::uint16_t{});
    case Type::Int32: return f(std::int32_t{});
    case Type::UInt32: return f(std::uint32_t{});
    case Type::Int64: return f(std::int64_t{});
    case Type::UInt64: return f(std::uint64_t{});
    case Type::Float32: return f(float{});
    case Type::Float64: break;
  }
  return f(double{});
}

inline bool is_integer(Type type) {
  return type != Type::Float32 && type != Type::Float64;
}

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

/// x as a T: integers are rounded to the nearest and held within T's range, not a number is zero.
template <class T>
T rounded(double x) {
  if constexpr (std::is_floating_point_v<T>) {
    return static_cast<T>(x);
  } else {
    // The largest double below 2^63 or 2^64 casts back without overflow; max() itself may round up to the power.
    const double low = static_cast<double>(std::numeric_limits<T>::lowest());
    const double high = std::nextafter(std::ldexp(1.0, std::numeric_limits<T>::digits), 0.0);
    return std::isnan(x) ? T{0} : static_cast<T>(std::clamp(std::round(x), low, high));
  }
}

/// True where a coordinate is still the one that was read: `now` is relative to `origin`, `file` is the file's. The
/// same subtraction as set_origin's, so that it holds for coordinates far outside the bounds too.
inline bool same_coordinate(double file, double origin, double now) {
  return now == file - origin || now + origin == file || (std::isnan(now) && std::isnan(file));
}

}  // namespace sinew::io
