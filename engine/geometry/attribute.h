#pragma once
/// Attribute: named values that belong to points. Its kind alone decides what a deformation does to it (skin.h).

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/check.h"
#include "engine/geometry/type.h"

namespace sinew {

/// What a value means, and therefore how it bends. p -> M p + t near the point, M the blended 3x3; J is M and, where
/// weights are a function of space, what their gradients add (skin_weights.h).
enum class Kind {
  Scalar,              ///< unchanged
  Color,               ///< unchanged
  Id,                  ///< unchanged
  Point,               ///< follows the map: M x + t
  Vector,              ///< J x, J the map's derivative by position
  Velocity,            ///< a unit of length a second: J x + how the map changes in a second
  Normal,              ///< cofactor(M) x, then its former length
  Quaternion,          ///< with LogScale a covariance: J S J^T
  LogScale,            ///< with Quaternion a covariance: J S J^T
  SphericalHarmonics,  ///< turned by the rotation nearest to J
};

const char* name_of(Kind kind);  ///< "scalar", "color", "id", "point", "vector", "normal", "quaternion", ...

/// Values of one name, `count` rows of `components`, in the type the file has, bit for bit.
struct Attribute {
  std::string name;                 ///< "normal", "color", "intensity": a group of the file's properties
  std::vector<std::string> fields;  ///< the file's own names, one a component ("nx", "ny", "nz")
  Kind kind = Kind::Scalar;
  Type type = Type::Float32;
  int components = 1;
  std::vector<std::byte> values;  ///< count x components, row by row, native endianness

  /// Which points value i belongs to. Empty: value i belongs to point i. Otherwise value i belongs to
  /// points[point_offsets[i]] .. points[point_offsets[i+1]-1] (a shared OBJ normal, the normal of an STL facet).
  std::vector<std::uint32_t> point_offsets, points;

  std::size_t row_size() const { return size_of(type) * static_cast<std::size_t>(components); }
  std::size_t count() const { return values.size() / row_size(); }
  bool per_point() const { return point_offsets.empty(); }

  /// Component c of row i as a number (for Int64/UInt64 beyond 2^53, rounded).
  double number(std::size_t i, int c) const;
  /// Stores x rounded to the attribute's type.
  void set_number(std::size_t i, int c, double x);

  /// The values as T; T must be the C++ type of `type`.
  template <class T>
  std::span<const T> as() const {
    CHECK(sizeof(T) == size_of(type), name, sizeof(T));
    return {reinterpret_cast<const T*>(values.data()), values.size() / sizeof(T)};
  }
  template <class T>
  std::span<T> as() {
    CHECK(sizeof(T) == size_of(type), name, sizeof(T));
    return {reinterpret_cast<T*>(values.data()), values.size() / sizeof(T)};
  }

  bool operator==(const Attribute&) const = default;
};

}  // namespace sinew
