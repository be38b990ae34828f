#include "apps/editor/residuals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/editor/marks.h"

namespace sinew::editor {

std::string name_of_handle(const document::Layer& layer, std::size_t handle) {
  const std::string& name = layer.handles[handle].name;
  return name.empty() ? fmt::format("Handle {}", handle + 1) : name;
}

std::vector<Residual> residuals_of(const Shape& input, std::span<const document::LayerResult> shown,
                                   const document::Layer& layer, std::size_t at) {
  const auto result = std::find_if(shown.begin(), shown.end(), [&](const auto& r) { return r.layer == at; });
  if (result == shown.end() || !result->of_frame || result->constraints.handles.size() < layer.handles.size())
    return {};
  std::vector<Residual> out;
  for (std::size_t h = 0; h < layer.handles.size(); ++h) {
    const Handle& handle = result->constraints.handles[h];
    if (handle.points.empty()) continue;
    const std::vector<Vec3> got = bent(input, shown, at + 1, handle.points);
    double sum = 0;
    for (std::size_t k = 0; k < got.size(); ++k) sum += (got[k] - handle.targets[k]).squaredNorm();
    out.push_back({h, name_of_handle(layer, h), got.size(), std::sqrt(sum / static_cast<double>(got.size()))});
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.distance > b.distance; });
  return out;
}

double rms_of(std::span<const Residual> residuals) {
  double sum = 0;
  for (const Residual& residual : residuals) sum += residual.distance * residual.distance;
  return residuals.empty() ? 0 : std::sqrt(sum / static_cast<double>(residuals.size()));
}

std::string csv_of(std::span<const Residual> residuals) {
  std::string out = "handle,points,distance\n";
  for (const Residual& residual : residuals) {
    std::string name = residual.name;
    if (name.find_first_of(",;\t\"\n\r") != std::string::npos) {
      std::string quoted = "\"";
      for (const char c : name) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
      name = quoted + "\"";
    }
    out += fmt::format("{},{},{}\n", name, residual.points, residual.distance);
  }
  return out;
}

}  // namespace sinew::editor
