#include "engine/document/evaluate.h"

#include <chrono>
#include <cmath>

#include "engine/geometry/bounds.h"
#include "engine/geometry/skin.h"
#include "engine/io/io.h"

namespace sinew::document {

namespace {

/// Distances of the bent handle points from their targets: what came out, whatever the solver thinks.
void measure_handles(const Constraints& constraints, std::span<const Vec3> bent, double diagonal, LayerReport& out) {
  double sum = 0;
  std::size_t count = 0;
  for (const Handle& handle : constraints.handles)
    for (std::size_t k = 0; k < handle.points.size(); ++k) {
      const double distance = (bent[handle.points[k]] - handle.targets[k]).norm() / diagonal;
      out.handle_max = std::max(out.handle_max, distance);
      sum += distance * distance;
      ++count;
    }
  if (count > 0) out.handle_rms = std::sqrt(sum / static_cast<double>(count));
}

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void measure(const Deformer& deformer, const LayerResult& result, const Shape& rest, std::span<const Vec3> bent,
             LayerReport& out) {
  std::vector<Vec3> moved(rest.size());
  out.bind = seconds_of([&] { deformer.bind(rest.positions, Gradients::No); });
  out.skin = seconds_of([&] { skin_points(*result.weights, *result.pose, rest.positions, moved); });
  out.quality = quality_of(rest, bent);
}

}  // namespace

Evaluation evaluate(const std::shared_ptr<const Shape>& input, std::span<const Layer> layers,
                    std::span<const Method> methods, const EvaluateOptions& options) {
  Workspace workspace(input, methods);
  UpdateOptions wanted;
  wanted.progress = options.progress;
  UpdateResult update = workspace.update(layers, wanted);
  if (update.stopped) throw io::Cancelled{};

  const double extent = bounds_of(input->positions).diagonal(), diagonal = extent > 0 ? extent : 1;
  Evaluation out;
  out.shape = input;
  for (const LayerResult& result : update.layers) {
    const Deformer& deformer = *workspace.deformer(result.layer);
    LayerReport report;
    report.method = layers[result.layer].method;
    report.solve = result.report;
    report.counts = deformer.counts();
    report.notes = deformer.notes();
    report.build = result.build_seconds;
    const auto bent = std::make_shared<Shape>(skin(*out.shape, *result.weights, *result.pose));
    measure_handles(result.constraints, bent->positions, diagonal, report);
    if (options.measure) measure(deformer, result, *out.shape, bent->positions, report);
    out.bindings.push_back(deformer.binding());
    out.reports.push_back(std::move(report));
    out.shape = bent;
  }
  out.layers = std::move(update.layers);
  return out;
}

}  // namespace sinew::document
