#pragma once
/// Coloring: the colour of each point from an attribute of the shape, or quiet tints that tell the parts of a scan set
/// from each other.

#include <string>
#include <vector>

#include "engine/document/workspace.h"
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

/// What View::color_by is for the energy of the chosen layer's structure, where no attribute has that name.
inline constexpr const char* energy_choice = "energy of the layer";

/// By LayerResult::map_energy, blended by the points' weights: where the structure is strained. Plain where the answer
/// has none.
Coloring energy_coloring(const Shape& shape, const document::LayerResult& layer);

}  // namespace sinew::editor
