#pragma once
/// Figures of the status line, from an answer of the solver.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/document/workspace.h"
#include "engine/geometry/shape.h"

namespace sinew::editor {

struct StatusFigures {
  int iterations = 0;        ///< of the chosen layer's last solve
  double milliseconds = 0;   ///< of that solve
  double build_seconds = 0;  ///< preparing the layer
  double residual = 0;       ///< rms distance of handle points from their targets, in units of the diagonal
  double max_stretch =
      0;  ///< the largest of |singular value - 1| of the points' 3x3 matrices, with its sign: 0.041 is +4.1 %
  std::size_t moved = 0;  ///< points displaced by more than 1e-6 of the diagonal
  bool sampled = true;    ///< stretch and moved come from a sample of at most 4096 points
  Status status = Status::Converged;
  std::string message;  ///< of the solver; or empty
};

/// `diagonal`: of the input's rest points. `stride` 1: from all points; otherwise from every stride-th, with `moved`
/// scaled up.
StatusFigures figures_of(const Shape& input, std::span<const document::LayerResult> layers, std::size_t chosen_layer,
                         double diagonal, std::size_t stride);

/// A stride that leaves at most 4096 points.
std::size_t sample_stride(std::size_t points);

}  // namespace sinew::editor
