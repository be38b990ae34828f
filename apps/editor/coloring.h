#pragma once
/// Coloring: the colour of each point from an attribute of the shape, or quiet tints that tell the parts of a scan set
/// from each other.

#include <string>
#include <vector>

#include "engine/geometry/shape.h"
#include "engine/gpu/points.h"

namespace sinew::editor {

/// Attributes that points can be coloured by: colours and single numbers, one a point.
std::vector<std::string> color_choices(const Shape& shape);

struct Coloring {
  std::vector<gpu::PointColor> colors;  ///< n, without marks
  bool has_range = false;               ///< colours stand for numbers from `low` (viridis: dark) to `high` (yellow)
  double low = 0, high = 0;             ///< the 1st and 99th percentile of the finite values
};

/// `attribute` empty or unknown: plain.
Coloring coloring_of(const Shape& shape, const std::string& attribute);

}  // namespace sinew::editor
