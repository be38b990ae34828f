#pragma once
/// Field: one number of each point that says what an edit does there, to be shown as its colour.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/document/workspace.h"

namespace sinew::document {

/// Displacement: how far the point went, in the file's unit. Stretch: of the singular values of its 3x3 matrix the one
/// farthest from 1, less 1, in percent. Rotation: the angle of that matrix' rotation (its polar factor), degrees.
/// Energy: Deformer::map_energy of the maps, blended by the point's weights, summed over layers. Influence: the weight
/// of one map, 0..1.
enum class FieldKind { Displacement, Stretch, Rotation, Energy, Influence };
inline constexpr const char* field_names[] = {"displacement", "stretch", "rotation", "energy", "influence"};
std::optional<FieldKind> field_named(std::string_view name);

struct Field {
  /// What its range of colours is: from the smallest to the largest, from 0 on, or as far below 0 as above.
  enum class Scale { Any, FromZero, Signed } scale = Scale::Any;
  std::string name;           ///< "stretch"
  std::string unit;           ///< " %", "°" or nothing: to be written after a number
  std::vector<float> values;  ///< n; NaN where there is none
};

/// `layers` bend the n points of `rest`, lowest first. `map`: whose influence, of the first of `layers`. A layer
/// without pose or weights, or with those of other points, does nothing.
Field field_of(FieldKind kind, std::span<const Vec3> rest, std::span<const LayerResult> layers, Index map = 0);

/// A number of each point that the shape has; nothing where `name` is no scalar or id with one component a point.
std::optional<Field> field_of(const Shape& shape, std::string_view name);

/// The map that has most to say about some points: with the largest sum of their weights.
Index strongest_map(const SkinWeights& weights, std::span<const Index> points);

/// Numbers that the ends of a range of colours stand for; low <= high.
struct ValueRange {
  double low = 0, high = 0;
  bool operator==(const ValueRange&) const = default;
};
/// The 1st to the 99th percentile of the finite values (of at most 200,000 of them); from 0 on, the 99th percentile; of
/// signed ones that of their magnitudes, on both sides. `around_zero`: what has both signs then counts as signed.
/// Nothing finite: 0..0.
ValueRange usual_range(std::span<const float> values, Field::Scale scale, bool around_zero = false);
/// The smallest and the largest finite value.
ValueRange extent_of(std::span<const float> values);

/// Of the singular values of M the one farthest from 1, less 1.
double stretch_of(const Mat3& M);
/// Degrees, 0..180.
double rotation_of(const Mat3& M);

}  // namespace sinew::document
