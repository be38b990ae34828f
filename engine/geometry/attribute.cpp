#include "engine/geometry/attribute.h"

namespace sinew {

std::size_t size_of(Type type) {
  return with_type(type, [](auto t) { return sizeof(t); });
}

const char* name_of(Type type) {
  static constexpr const char* names[] = {"int8",   "uint8", "int16",  "uint16",  "int32",
                                          "uint32", "int64", "uint64", "float32", "float64"};
  return names[static_cast<int>(type)];
}

const char* name_of(Kind kind) {
  static constexpr const char* names[] = {"scalar",   "color",  "id",         "point",     "vector",
                                          "velocity", "normal", "quaternion", "log-scale", "spherical-harmonics"};
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
