#pragma once
/// Residuals: how far from its target each handle of a layer came to be.

#include <span>
#include <string>
#include <vector>

#include "engine/document/project.h"
#include "engine/document/workspace.h"

namespace sinew::editor {

struct Residual {
  std::size_t handle = 0;  ///< of Layer::handles
  std::string name;
  std::size_t points = 0;
  double distance = 0;  ///< rms over its points, in the shape's unit
};

/// Its own name, or "Handle 3".
std::string name_of_handle(const document::Layer& layer, std::size_t handle);

/// The farthest first. `shown`: results of all layers; `at`: index of `layer`. None where the answer has another number
/// of handles (it is older), or where its points are not those of `input`.
std::vector<Residual> residuals_of(const Shape& input, std::span<const document::LayerResult> shown,
                                   const document::Layer& layer, std::size_t at);

double rms_of(std::span<const Residual> residuals);

/// "handle,points,distance" and a row each.
std::string csv_of(std::span<const Residual> residuals);

}  // namespace sinew::editor
