#pragma once
/// Type: the ten types that values of an attribute have, in memory and in files.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace sinew {

enum class Type { Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64, Float32, Float64 };

std::size_t size_of(Type type);  ///< bytes of one value
const char* name_of(Type type);  ///< "int8" ... "float64"

inline bool is_integer(Type type) {
  return type != Type::Float32 && type != Type::Float64;
}

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

}  // namespace sinew
