#include "engine/document/evaluate.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "engine/geometry/bounds.h"
#include "engine/geometry/skin.h"
#include "engine/io/io.h"

namespace sinew::document {

namespace {

/// Of each handle that has points, by what came out.
void measure_each(const Layer& layer, const Constraints& constraints, std::span<const Vec3> bent, double diagonal,
                  LayerReport& out) {
  for (std::size_t h = 0; h < constraints.handles.size(); ++h) {
    const Handle& handle = constraints.handles[h];
    if (handle.points.empty()) continue;
    HandleReport report;
    if (h < layer.handles.size()) report.name = layer.handles[h].name;
    report.points = handle.points.size();
    double sum = 0;
    for (std::size_t k = 0; k < handle.points.size(); ++k) {
      const double distance = (bent[handle.points[k]] - handle.targets[k]).norm() / diagonal;
      report.max = std::max(report.max, distance);
      sum += distance * distance;
    }
    report.rms = std::sqrt(sum / static_cast<double>(report.points));
    out.handles.push_back(std::move(report));
  }
}

/// Distances of the bent handle points from their targets: what came out, whatever the solver thinks.
void measure_handles(const Layer& layer, const Constraints& constraints, std::span<const Vec3> bent, double diagonal,
                     LayerReport& out) {
  measure_each(layer, constraints, bent, diagonal, out);
  // Of places in space only the method knows where they came to be.
  const auto has_places = [](const Handle& handle) { return !handle.places.empty(); };
  if (std::any_of(constraints.handles.begin(), constraints.handles.end(), has_places)) {
    out.handle_max = out.solve.handle_max;
    out.handle_rms = out.solve.handle_rms;
    return;
  }
  double sum = 0;
  std::size_t count = 0;
  for (const HandleReport& handle : out.handles) {
    out.handle_max = std::max(out.handle_max, handle.max);
    sum += handle.rms * handle.rms * static_cast<double>(handle.points);
    count += handle.points;
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

bool has_velocities(const Shape& shape) {
  return std::any_of(shape.attributes.begin(), shape.attributes.end(),
                     [](const Attribute& attribute) { return attribute.kind == Kind::Velocity; });
}

UpdateResult solved(Workspace& workspace, std::span<const Layer> layers, int frame, const EvaluateOptions& options) {
  UpdateOptions wanted;
  wanted.frame = frame;
  wanted.progress = options.progress;
  UpdateResult update = workspace.update(layers, wanted);
  if (update.stopped) throw io::Cancelled{};
  return update;
}

/// How fast each map of each layer changes at a frame, a second, from the poses at the frames beside it. Empty where
/// nothing changes.
std::vector<Pose> rates_of(Workspace& workspace, std::span<const Layer> layers, int frame,
                           const EvaluateOptions& options) {
  const Sequence& sequence = workspace.sequence();
  const bool keyed =
      std::any_of(layers.begin(), layers.end(), [](const Layer& layer) { return layer.on && !layer.keys.empty(); });
  if (sequence.frames.size() < 2 || (workspace.stream() && !keyed)) return {};
  const auto here = std::lower_bound(sequence.frames.begin(), sequence.frames.end(), frame);
  const int before = here == sequence.frames.begin() ? frame : *(here - 1);
  const int after = here + 1 == sequence.frames.end() ? frame : *(here + 1);
  const double seconds = (after - before) / sequence.rate;
  const UpdateResult first = solved(workspace, layers, before, options),
                     last = solved(workspace, layers, after, options);
  std::vector<Pose> out;
  for (std::size_t i = 0; i < first.layers.size(); ++i) {
    const Pose &a = *first.layers[i].pose, &b = *last.layers[i].pose;
    Pose rate(a.size());
    for (std::size_t j = 0; j < a.size(); ++j) rate[j] = (b[j] - a[j]) / seconds;
    out.push_back(std::move(rate));
  }
  return out;
}

/// The layer's weights; with gradients where attributes of `rest` bend by them and they are a function of space.
std::shared_ptr<const SkinWeights> weights_to_bend(const Deformer& deformer, const LayerResult& result,
                                                   const Shape& rest) {
  if (!needs_gradients(rest)) return result.weights;
  auto bound = std::make_shared<SkinWeights>(deformer.bind(rest.positions, Gradients::Yes));
  // Gradients of other weights (points may be bound along the surface) say nothing about these.
  const bool same = bound->maps == result.weights->maps && bound->weights == result.weights->weights;
  return same ? bound : result.weights;
}

}  // namespace

Evaluation evaluate(const std::shared_ptr<const Shape>& input, std::span<const Layer> layers,
                    std::span<const Method> methods, const EvaluateOptions& options) {
  Workspace workspace(input, methods);
  return evaluate(workspace, layers, workspace.sequence().frames.front(), options);
}

Evaluation evaluate(Workspace& workspace, std::span<const Layer> layers, int frame, const EvaluateOptions& options) {
  const std::shared_ptr<const Shape> input = workspace.input(frame);
  std::vector<Pose> rates;
  if (has_velocities(*input)) rates = rates_of(workspace, layers, frame, options);
  UpdateResult update = solved(workspace, layers, frame, options);

  const double extent = bounds_of(input->positions).diagonal(), diagonal = extent > 0 ? extent : 1;
  // Of a mesh animation the weights were bound once, to points that have gone elsewhere since: they do not change as a
  // point moves.
  const bool by_place = workspace.stream() || workspace.sequence().frames.size() == 1;
  Evaluation out;
  out.shape = input;
  for (std::size_t i = 0; i < update.layers.size(); ++i) {
    const LayerResult& result = update.layers[i];
    const Deformer& deformer = *workspace.deformer(result.layer);
    LayerReport report;
    report.method = layers[result.layer].method;
    report.solve = result.report;
    report.counts = deformer.counts();
    report.notes = deformer.notes();
    if (const Markers* markers = workspace.markers(result.layer))
      report.notes.insert(report.notes.end(), markers->notes().begin(), markers->notes().end());
    if (out.reports.empty()) {
      const std::vector<std::string> left = not_bent(*input);
      report.notes.insert(report.notes.end(), left.begin(), left.end());
    }
    report.build = result.build_seconds;
    const auto weights = by_place ? weights_to_bend(deformer, result, *out.shape) : result.weights;
    const Pose* rate = rates.empty() ? nullptr : &rates[i];
    const auto bent = std::make_shared<Shape>(skin(*out.shape, *weights, *result.pose, rate));
    if (workspace.stream()) {
      const std::shared_ptr<const Shape> rest = workspace.rest(result.layer);
      std::vector<Vec3> moved(rest->size());
      skin_points(deformer.weights(), *result.pose, rest->positions, moved);
      measure_handles(layers[result.layer], result.constraints, moved, diagonal, report);
    } else {
      measure_handles(layers[result.layer], result.constraints, bent->positions, diagonal, report);
    }
    if (options.measure) measure(deformer, result, *out.shape, bent->positions, report);
    out.bindings.push_back(deformer.binding());
    out.map_energies.push_back(deformer.map_energy());
    out.reports.push_back(std::move(report));
    out.shape = bent;
  }
  out.layers = std::move(update.layers);
  return out;
}

}  // namespace sinew::document
