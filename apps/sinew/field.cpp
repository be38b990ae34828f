#include "apps/sinew/field.h"

#include <algorithm>
#include <cmath>

#include "engine/gpu/viridis.h"

namespace sinew::app {

namespace {

void find_range(Field& field) {
  std::vector<double> finite;
  for (const double value : field.values)
    if (std::isfinite(value)) finite.push_back(value);
  if (finite.empty()) return;
  const auto at = finite.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(finite.size() - 1));
  std::nth_element(finite.begin(), at, finite.end());
  field.high = *at;
  field.most = *std::max_element(at, finite.end());
}

}  // namespace

Field energy_field(const document::Evaluation& evaluation) {
  Field field;
  field.name = "energy";
  field.values.assign(evaluation.shape->size(), 0.0);
  for (std::size_t layer = 0; layer < evaluation.layers.size(); ++layer) {
    const SkinWeights& weights = *evaluation.layers[layer].weights;
    const std::vector<double>& energies = evaluation.map_energies[layer];
    for (std::size_t i = 0; i < field.values.size(); ++i)
      for (std::uint64_t e = weights.offsets[i]; e < weights.offsets[i + 1]; ++e)
        field.values[i] += static_cast<double>(weights.weights[e]) * energies[weights.maps[e]];
  }
  find_range(field);
  return field;
}

Field displacement_field(const Shape& rest, const Shape& bent) {
  Field field;
  field.name = "displacement";
  field.values.resize(rest.size());
  for (std::size_t i = 0; i < rest.size(); ++i) field.values[i] = (bent.positions[i] - rest.positions[i]).norm();
  find_range(field);
  return field;
}

gpu::PointColor color_of(const Field& field, double value) {
  if (!std::isfinite(value)) return {};
  return gpu::viridis(field.high > 0 ? value / field.high : 0);
}

}  // namespace sinew::app
