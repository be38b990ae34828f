#pragma once
/// Field: a number of each point, to be shown as its colour.

#include <string>
#include <vector>

#include "engine/document/evaluate.h"
#include "engine/gpu/points.h"

namespace sinew::app {

struct Field {
  std::string name;
  std::vector<double> values;  ///< n; what is not finite is shown grey
  double high = 0;  ///< the brightest colour stands for this and more (99 % of the values are below); 0 is the darkest
  double most = 0;  ///< the largest finite value
};

/// How much energy the graph spends near each point: that of its maps, blended by its weights, summed over layers; in
/// normalised coordinates (Deformer::map_energy).
Field energy_field(const document::Evaluation& evaluation);

/// How far each point went, in the file's unit.
Field displacement_field(const Shape& rest, const Shape& bent);

gpu::PointColor color_of(const Field& field, double value);

}  // namespace sinew::app
