#include "apps/editor/figures.h"

#include <algorithm>
#include <cmath>

#include "apps/editor/marks.h"
#include "engine/document/field.h"
#include "engine/geometry/bounds.h"

namespace sinew::editor {

std::size_t sample_stride(std::size_t points) {
  return std::max<std::size_t>(1, (points + 4095) / 4096);
}

StatusFigures figures_of(const Shape& input, std::span<const document::LayerResult> layers, std::size_t chosen_layer,
                         double diagonal, std::size_t stride) {
  StatusFigures out;
  for (const document::LayerResult& layer : layers) {
    if (layer.layer != chosen_layer) continue;
    out.iterations = layer.report.iterations;
    out.milliseconds = 1000 * layer.report.solve_seconds;
    out.build_seconds = layer.build_seconds;
    out.residual = layer.report.handle_rms;
    out.status = layer.report.status;
    out.message = layer.report.message;
  }
  const double least = 1e-6 * diagonal;
  std::size_t looked_at = 0;
  for (std::size_t i = 0; i < input.size(); i += stride) {
    const Vec3& rest = input.positions[i];
    ++looked_at;
    if (!rest.allFinite()) continue;
    Vec3 position;
    const double stretch = document::stretch_of(bent_matrix(layers, rest, i, position));
    if (std::abs(stretch) > std::abs(out.max_stretch)) out.max_stretch = stretch;
    out.moved += (position - rest).norm() > least;
  }
  out.sampled = stride > 1;
  if (out.sampled && looked_at > 0)
    out.moved = static_cast<std::size_t>(static_cast<double>(out.moved) * static_cast<double>(input.size()) /
                                         static_cast<double>(looked_at));
  return out;
}

}  // namespace sinew::editor
