#include "engine/geometry/attribute.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace sinew {

namespace {

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

}  // namespace

std::size_t size_of(Type type) {
  return with_type(type, [](auto t) { return sizeof(t); });
}

const char* name_of(Type type) {
  static constexpr const char* names[] = {"int8",   "uint8", "int16",  "uint16",  "int32",
                                          "uint32", "int64", "uint64", "float32", "float64"};
  return names[static_cast<int>(type)];
}

const char* name_of(Kind kind) {
  static constexpr const char* names[] = {
      "scalar", "color", "id", "point", "vector", "normal", "quaternion", "log-scale", "spherical-harmonics"};
  return names[static_cast<int>(kind)];
}

double Attribute::number(std::size_t i, int c) const {
  const std::byte* at = values.data() + i * row_size() + static_cast<std::size_t>(c) * size_of(type);
  return with_type(type, [at](auto t) {
    std::memcpy(&t, at, sizeof(t));
    return static_cast<double>(t);
  });
}

void Attribute::set_number(std::size_t i, int c, double x) {
  std::byte* at = values.data() + i * row_size() + static_cast<std::size_t>(c) * size_of(type);
  with_type(type, [at, x](auto t) {
    t = rounded<decltype(t)>(x);
    std::memcpy(at, &t, sizeof(t));
    return 0;
  });
}

}  // namespace sinew
