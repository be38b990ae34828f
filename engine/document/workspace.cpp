#include "engine/document/workspace.h"

#include <chrono>

#include "engine/document/settings.h"
#include "engine/geometry/skin.h"

namespace sinew::document {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

bool same_constraints(const Constraints& a, const Constraints& b) {
  return a.fixed == b.fixed && a.handles == b.handles;
}

}  // namespace

Workspace::Workspace(std::shared_ptr<const Shape> input, std::span<const Method> methods)
    : input_(input), methods_(methods), selector_(std::move(input)) {}

const Deformer* Workspace::deformer(std::size_t layer) const {
  return layer < kept_.size() ? kept_[layer].deformer.get() : nullptr;
}

std::shared_ptr<const Shape> Workspace::rest(std::size_t layer) const {
  return layer < kept_.size() ? kept_[layer].rest : nullptr;
}

std::shared_ptr<const Shape> Workspace::output(Kept* kept) const {
  if (kept == nullptr) return input_;
  if (kept->output == nullptr)
    kept->output = std::make_shared<const Shape>(skin(*kept->rest, *kept->result.weights, *kept->result.pose));
  return kept->output;
}

UpdateResult Workspace::update(std::span<const Layer> layers, const UpdateOptions& options) {
  check_layers(layers, methods_);
  kept_.resize(layers.size());
  UpdateResult out;
  Kept* below = nullptr;
  bool moved_below = false;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const Layer& layer = layers[i];
    Kept& kept = kept_[i];
    if (!layer.on) {
      kept = {};
      continue;
    }
    if (moved_below && kept.deformer != nullptr && options.solve.quality == SolveOptions::Quality::Interactive) {
      kept.result.solved = false;
      out.layers.push_back(kept.result);
      below = &kept;
      continue;
    }
    const std::shared_ptr<const Shape> rest = output(below);
    const bool same = kept.deformer != nullptr && kept.rest == rest && kept.layer.method == layer.method &&
                      kept.layer.settings == layer.settings && kept.layer.nodes == layer.nodes;
    if (!same) {
      kept = {};
      kept.rest = rest;
      if (!make(kept, layer, i, options)) kept = {};
    }
    const std::shared_ptr<const Pose> before = kept.result.pose;
    if (kept.deformer == nullptr || !solve(kept, layer, options, out.layers)) {
      out.stopped = true;
      return out;
    }
    if (kept.result.pose != before) {
      kept.output = nullptr;
      moved_below = true;
    }
    below = &kept;
  }
  return out;
}

bool Workspace::make(Kept& kept, const Layer& layer, std::size_t index, const UpdateOptions& options) {
  const Method& method = method_of(layer, methods_);
  const Clock::time_point begin = Clock::now();
  const auto progress = [&](double fraction) {
    return !options.progress || options.progress("building", index, fraction);
  };
  const Settings settings = settings_of(layer, method);
  kept.deformer = method.make(kept.rest, settings, {selector_.points(layer.nodes), false, {}}, progress);
  if (kept.deformer == nullptr) return false;
  kept.result.layer = index;
  kept.result.build_seconds = seconds_since(begin);
  // The weights live in the deformer, and never change while it lives.
  kept.result.weights = std::shared_ptr<const SkinWeights>(kept.deformer, &kept.deformer->weights());
  kept.result.structure = std::make_shared<const Deformer::Structure>(kept.deformer->structure());
  kept.layer = layer;
  return true;
}

bool Workspace::solve(Kept& kept, const Layer& layer, const UpdateOptions& options, std::vector<LayerResult>& done) {
  LayerResult& result = kept.result;
  const bool first = result.pose == nullptr, start_again = first || !(kept.layer.start == layer.start);
  Constraints constraints = selector_.constraints(layer, kept.rest->positions);
  const bool better =
      options.solve.quality == SolveOptions::Quality::Final && kept.quality != SolveOptions::Quality::Final;
  if (start_again || better || !kept.settled || !same_constraints(constraints, result.constraints)) {
    if (start_again) {
      kept.deformer->reset();
      const std::vector<Affine>& start = layer.start.get();
      if (!start.empty() && start.size() != kept.deformer->pose().size())
        throw place_error(layer.place, "layer", std::to_string(kept.deformer->pose().size()) + " maps in \"start\"",
                          std::to_string(start.size()));
      if (!start.empty()) kept.deformer->start_from(start);
    }
    kept.layer = layer;
    result.constraints = std::move(constraints);
    SolveOptions solve = options.solve;
    done.push_back(result);
    solve.on_iteration = [&](const Pose& pose) {
      if (options.on_iteration) {
        done.back().pose = std::make_shared<const Pose>(pose);
        if (!options.on_iteration(done)) return false;
      }
      return !options.progress || options.progress("solving", result.layer, 0);
    };
    kept.settled = false;
    kept.quality = SolveOptions::Quality::Interactive;
    kept.output = nullptr;
    result.report = kept.deformer->solve(result.constraints, solve);
    result.pose = std::make_shared<const Pose>(kept.deformer->pose());
    kept.settled = result.report.status != Status::Stopped;
    if (kept.settled) kept.quality = options.solve.quality;
    done.pop_back();
  }
  result.solved = true;
  done.push_back(result);
  return kept.settled;
}

}  // namespace sinew::document
