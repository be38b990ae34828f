#pragma once
/// AttributeRange: one number of each point, how often which occurs, and the range of it that is to be selected.
/// 1,000,000 numbers are read, counted and compared within a frame each (tests/apps/editor_core_select_test.cpp).

#include <memory>
#include <string>
#include <vector>

#include "apps/editor/point_set.h"

namespace sinew::editor {

struct AttributeRange {
  std::string name;                                   ///< one of range_choices
  std::shared_ptr<const std::vector<double>> values;  ///< n; null: none
  double least = 0, most = 0;                         ///< of the finite values
  std::vector<std::uint32_t> bins;                    ///< points in each equal part from `least` to `most`
  double low = 0, high = 0;                           ///< both belong to the range
};

/// "x", "y", "z" (at rest, in the file's coordinates), then the attributes of points: "intensity", "color.red",
/// "normal.nx".
std::vector<std::string> range_choices(const Shape& shape);

/// The whole of what `name` says, so that all finite values are in the range; of an unknown name no values.
AttributeRange range_of(const Shape& shape, const std::string& name, std::size_t bins = 128);

/// What stands in brackets at the end of a name: "m" of "height (m)" and of "height [m]"; else nothing.
std::string unit_of(const std::string& name);

PointSet in_range(const AttributeRange& range);

}  // namespace sinew::editor
