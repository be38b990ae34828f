#include "tests/benchmarks/frames.h"

#include <algorithm>
#include <chrono>

#include "apps/samples/edits.h"
#include "apps/samples/streams.h"
#include "apps/samples/walk.h"
#include "deformers/methods.h"
#include "engine/document/edit.h"
#include "engine/document/evaluate.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/skin.h"

namespace sinew::benchmarks {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

}  // namespace

MovingCase moving_case(const std::string& name) {
  const auto frames = std::make_shared<std::vector<std::shared_ptr<const Shape>>>();
  const auto take = [&](int, const Shape& shape) { frames->push_back(std::make_shared<const Shape>(shape)); };
  if (name == "walk")
    samples::make_walk(samples::walk_cycle, take);
  else
    samples::make_jet(72, take);
  Sequence sequence;
  sequence.frames.clear();
  for (std::size_t f = 1; f <= frames->size(); ++f) sequence.frames.push_back(static_cast<int>(f));
  sequence.load = [frames](int frame) { return (*frames)[static_cast<std::size_t>(frame - 1)]; };
  MovingCase out{std::make_shared<const Sequence>(sequence), document::parse_edit(name, samples::edit_of(name)).layers};
  if (name == "walk") out.layers[0].settings.push_back({"nodes", 303.0, {}});
  return out;
}

FrameSeconds time_frames(const MovingCase& c) {
  document::Workspace workspace(c.input, methods());
  document::UpdateOptions options;
  options.frame = c.input->frames.front();
  workspace.update(c.layers, options);  // structure and keys
  const int threads = thread_count();
  set_thread_count(1);
  std::vector<double> solve, skin, whole, iterations;
  FrameSeconds out;
  for (const int frame : c.input->frames) {
    if (frame == c.input->frames.front()) continue;
    const std::shared_ptr<const Shape> shape = c.input->load(frame);
    const Clock::time_point begin = Clock::now();
    const document::Evaluation evaluation = document::evaluate(workspace, c.layers, frame);
    whole.push_back(seconds_since(begin));
    const SolveReport& report = evaluation.reports.at(0).solve;
    solve.push_back(report.prefactor_seconds + report.solve_seconds);
    iterations.push_back(report.iterations);
    const Clock::time_point moving = Clock::now();
    std::vector<Vec3> bent(shape->size());
    SkinWeights bound;
    if (workspace.stream()) bound = workspace.deformer(0)->bind(shape->positions, Gradients::No);
    skin_points(workspace.stream() ? bound : *evaluation.layers[0].weights, *evaluation.layers[0].pose,
                shape->positions, bent);
    skin.push_back(seconds_since(moving));
    out.points = static_cast<double>(shape->size());
    out.nodes = static_cast<double>(evaluation.layers[0].pose->size());
  }
  set_thread_count(threads);
  out.solve = median(solve);
  out.skin = median(skin);
  out.whole = median(whole);
  out.iterations = median(iterations);
  return out;
}

}  // namespace sinew::benchmarks
