#include "engine/document/workspace.h"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "engine/document/examples.h"
#include "engine/document/keys.h"
#include "engine/document/pose_blend.h"
#include "engine/document/settings.h"
#include "engine/geometry/skin.h"
#include "engine/io/io.h"

namespace sinew::document {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

bool same_constraints(const Constraints& a, const Constraints& b) {
  return a.fixed == b.fixed && a.handles == b.handles && a.rigid == b.rigid && a.stiffness == b.stiffness &&
         a.example_weights == b.example_weights;
}

bool names_targets(const Layer& layer) {
  const auto to = [](const Motion& motion) { return !motion.to.get().empty(); };
  return std::any_of(layer.handles.begin(), layer.handles.end(), [&](const auto& h) { return to(h.motion); }) ||
         std::any_of(layer.keys.begin(), layer.keys.end(),
                     [&](const Key& key) { return std::any_of(key.handles.begin(), key.handles.end(), to); });
}

/// Whether the same points are marked; with targets of their own, the check of their number has to be made again.
bool same_marks(const Layer& a, const Layer& b) {
  return !names_targets(a) && !names_targets(b) && a.fixed == b.fixed && a.rigid == b.rigid &&
         a.stiffness == b.stiffness && a.frame == b.frame &&
         std::equal(a.handles.begin(), a.handles.end(), b.handles.begin(), b.handles.end(),
                    [](const HandleEdit& x, const HandleEdit& y) { return x.points == y.points; }) &&
         a.keys.empty() == b.keys.empty() && (a.keys.empty() || a.keys[0].frame == b.keys[0].frame);
}

std::vector<Cut> cuts_of(const Layer& layer, const Vec3& origin) {
  std::vector<Cut> out;
  for (const CutEdit& edit : layer.cuts) {
    out.push_back({{}, edit.depth});
    for (const Vec3& p : edit.path) out.back().path.push_back(p - origin);
  }
  return out;
}

/// Positions of points, then places.
std::vector<Vec3> at(std::span<const Index> points, std::span<const Vec3> places, const Shape& shape) {
  std::vector<Vec3> out;
  out.reserve(points.size() + places.size());
  for (const Index i : points) out.push_back(shape.positions[i]);
  out.insert(out.end(), places.begin(), places.end());
  return out;
}

/// The tets that a layer brings along, relative to `origin`.
std::shared_ptr<const Shape> solid_of(const Layer& layer, const Vec3& origin) {
  auto out = std::make_shared<Shape>(*io::read(layer.tets));
  if (out->tets.empty())
    throw place_error(layer.place, "layer", "a file of tets in \"tets\"", std::string("a ") + representation(*out));
  for (Vec3& p : out->positions) p += out->origin - origin;
  out->origin = origin;
  return out;
}

}  // namespace

std::vector<Key> keys_of(const Layer& layer, int frame) {
  std::vector<Key> keys = layer.keys;
  if (keys.empty()) {
    keys.emplace_back();
    keys.back().frame = frame;
  }
  for (Key& key : keys) {
    if (key.example_weights.empty()) key.example_weights = layer.example_weights;
    for (std::size_t h = key.handles.size(); h < layer.handles.size(); ++h)
      key.handles.push_back(layer.handles[h].motion);
  }
  return keys;
}

Workspace::Workspace(std::shared_ptr<const Sequence> input, std::span<const Method> methods)
    : footage_(std::move(input)), methods_(methods) {}

Workspace::Workspace(std::shared_ptr<const Shape> shape, std::span<const Method> methods)
    : Workspace(std::make_shared<const Sequence>(still(std::move(shape))), methods) {}

const Deformer* Workspace::deformer(std::size_t layer) const {
  return layer < kept_.size() ? kept_[layer].deformer.get() : nullptr;
}

const Markers* Workspace::markers(std::size_t layer) const {
  return layer < kept_.size() ? kept_[layer].markers.get() : nullptr;
}

std::shared_ptr<const Shape> Workspace::rest(std::size_t layer) const {
  return layer < kept_.size() ? kept_[layer].followed : nullptr;
}

UpdateResult Workspace::update(std::span<const Layer> layers, const UpdateOptions& options) {
  check_layers(layers, methods_);
  layers_ = layers;
  options_ = &options;
  frame_ = options.frame.value_or(footage_.first_frame());
  footage_.require(frame_, {}, "frame");
  footage_.set_layers(layers);
  done_.clear();
  if (footage_.stream()) points_ = footage_.input(frame_)->positions;
  kept_.resize(layers.size());
  bool moved_below = false, stopped = false;
  for (std::size_t i = 0; i < layers.size() && !stopped; ++i) {
    Kept& kept = kept_[i];
    if (!layers[i].on) {
      kept = {};
      continue;
    }
    const auto known = kept.solved.find(frame_);
    const std::shared_ptr<const Pose> before = known == kept.solved.end() ? nullptr : known->second.pose;
    const bool carried =
        moved_below && before != nullptr && options.solve.quality == SolveOptions::Quality::Interactive;
    stopped = !carried && !bring(i, frame_);
    const auto now = kept.solved.find(frame_);
    if (now == kept.solved.end() || now->second.pose == nullptr) continue;  // stopped before there was any
    done_.push_back(result(i, now->second));
    done_.back().solved = !carried;
    moved_below = moved_below || now->second.pose != before;
    if (footage_.stream()) skin_points(*done_.back().weights, *done_.back().pose, points_, points_);
  }
  forget_frames();
  return {std::exchange(done_, {}), stopped};
}

/// Makes solved(i, frame) true of the layers as they are; false where a callback stopped it.
bool Workspace::bring(std::size_t i, int frame) {
  Kept& kept = kept_[i];
  const Layer& layer = layers_[i];
  const int base_frame = footage_.frame_of(layer);
  const std::shared_ptr<const Shape> base = rest_of(i, base_frame);
  if (base == nullptr) return false;
  if (kept.deformer == nullptr || kept.base != base || !same_structure(kept.layer, layer)) {
    if (!make(i, base)) return false;
  }
  if (options_->solve.quality == SolveOptions::Quality::Final && !fit(i, base_frame)) return false;
  return bring_made(i, frame);
}

/// Refines the structure, where the method does, for what the keys ask of it. A structure that was refined for another
/// edit is made anew, so that the answer does not depend on what was tried before.
bool Workspace::fit(std::size_t i, int base_frame) {
  Kept& kept = kept_[i];
  const Layer& layer = layers_[i];
  if (kept.fitted == layer) return true;
  if (kept.grown && !make(i, kept.base)) return false;
  for (const Key& key : keys_of(layer, base_frame)) {
    for (;;) {
      if (!bring_made(i, key.frame)) return false;
      std::shared_ptr<Deformer> finer = kept.deformer->refined();
      if (finer == nullptr) break;
      const std::shared_ptr<const Shape> rest = kept.followed;
      install(kept, std::move(finer));
      kept.followed = rest;
      kept.grown = true;
      Solved& now = kept.solved[key.frame];
      now.rest = rest;
      Wanted asked = *wanted(i, key.frame, *rest);
      now.constraints = std::move(asked.constraints);
      now.motions = std::move(asked.motions);
      now.centres = std::move(asked.centres);
      if (!solve(i, key.frame, now, From::Here)) return false;
    }
  }
  if (const std::size_t start = layer.start.get().size(); start > 0) {
    const std::size_t maps = kept.deformer->pose().size();
    if (start != maps)
      throw place_error(layer.place, "layer", std::to_string(maps) + " maps in \"start\"", std::to_string(start));
    if (kept.grown) kept.solved.clear();  // the way there began elsewhere
  }
  kept.fitted = layer;
  return true;
}

bool Workspace::bring_made(std::size_t i, int frame) {
  Kept& kept = kept_[i];
  const Layer& layer = layers_[i];
  if (!(kept.layer.start == layer.start)) kept.solved.clear();
  if (!same_marks(kept.layer, layer)) kept.marked.reset();
  kept.layer = layer;
  if (!layer.markers) kept.markers = nullptr;
  if (layer.markers && (kept.markers == nullptr || kept.markers->edit() != *layer.markers))
    kept.markers = std::make_shared<const Markers>(*layer.markers, *kept.base);
  const std::shared_ptr<const Shape> rest = rest_of(i, frame);
  if (rest == nullptr) return false;
  std::optional<Wanted> asked = wanted(i, frame, *rest);
  if (!asked) return false;

  Solved& now = kept.solved[frame];
  if (now.rest != rest) now = {};
  now.rest = rest;
  const std::shared_ptr<const Pose> from = now.from, to = now.to;
  if (!start(i, frame, now)) return false;
  now.motions = std::move(asked->motions);
  now.centres = std::move(asked->centres);
  const bool better =
      options_->solve.quality == SolveOptions::Quality::Final && now.quality != SolveOptions::Quality::Final;
  if (now.pose != nullptr && now.settled && !better && from == now.from && to == now.to &&
      same_constraints(asked->constraints, now.constraints))
    return true;
  now.constraints = std::move(asked->constraints);
  return solve(i, frame, now, From::Keys);
}

bool Workspace::make(std::size_t i, const std::shared_ptr<const Shape>& base) {
  Kept& kept = kept_[i];
  const Layer& layer = layers_[i];
  kept = {};
  const Method& method = method_of(layer, methods_);
  const Clock::time_point begin = Clock::now();
  const auto progress = [&](double fraction) {
    return !options_->progress || options_->progress("building", i, fraction);
  };
  std::vector<Index> points = footage_.path_points(layer);
  for (const Selection& selection : layer.nodes) {
    const std::vector<Index> more = footage_.points(layer, selection, false);
    points.insert(points.end(), more.begin(), more.end());
  }
  const std::vector<Cut> cuts = cuts_of(layer, base->origin);
  const std::shared_ptr<const Shape> solid = layer.tets.empty() ? nullptr : solid_of(layer, base->origin);
  StructureWishes wishes{points, layer.path.has_value(), cuts, solid, {}, {}};
  if (!layer.examples_of.empty()) wishes.examples_of = examples_of_another(layer, *base);
  std::vector<ExampleName> names;
  for (const Example& example : examples_of(layer, *base, progress)) {
    wishes.examples.push_back(example.shape);
    names.push_back({example.name, example.path, example.entry, layer.examples[example.entry]});
  }
  std::shared_ptr<Deformer> deformer = method.make(base, settings_of(layer, method), wishes, progress);
  if (deformer == nullptr) return false;
  install(kept, std::move(deformer));
  kept.examples = std::move(names);
  kept.layer = layer;
  kept.base = kept.followed = base;
  kept.build_seconds = seconds_since(begin);
  return true;
}

void Workspace::install(Kept& kept, std::shared_ptr<Deformer> deformer) {
  kept.deformer = std::move(deformer);
  kept.solved.clear();
  kept.held = nullptr;
  kept.structure = nullptr;
  kept.bound_at = nullptr;
  // The weights live in the deformer, and never change while it lives.
  kept.weights = std::shared_ptr<const SkinWeights>(kept.deformer, &kept.deformer->weights());
}

/// Puts the deformer where the solve of a frame is to begin. Notes in `now` what that depends on.
bool Workspace::start(std::size_t i, int frame, Solved& now) {
  Kept& kept = kept_[i];
  const Layer& layer = kept.layer;
  const int base_frame = footage_.frame_of(layer);
  const std::vector<Key> keys = keys_of(layer, base_frame);
  const KeySpan span = span_of(keys, frame);
  const int from = keys[span.first].frame, to = keys[span.second].frame;
  now.from = now.to = nullptr;
  if (frame == from) return true;
  if (!bring_made(i, from) || !bring_made(i, to)) return false;
  now.from = kept.solved.at(from).pose;
  now.to = kept.solved.at(to).pose;
  return true;
}

bool Workspace::solve(std::size_t i, int frame, Solved& now, From where) {
  Kept& kept = kept_[i];
  Deformer& deformer = *kept.deformer;
  const Layer& layer = kept.layer;
  const bool moves = !footage_.still() || !layer.keys.empty();
  const bool canonical = moves && options_->solve.quality == SolveOptions::Quality::Final;
  if (where == From::Here) {
    // A structure just refined begins where the one before it ended.
  } else if (now.from != nullptr) {
    const std::vector<Key> keys = keys_of(layer, footage_.frame_of(layer));
    const KeySpan span = span_of(keys, frame);
    const Solved &from = kept.solved.at(keys[span.first].frame), &to = kept.solved.at(keys[span.second].frame);
    Deformer::Structure there;
    if (span.u > 0) {
      follow(kept, to.rest);
      there = deformer.structure();
    }
    follow(kept, from.rest);
    deformer.reset();
    deformer.start_from(*from.pose);
    const Deformer::Structure here = span.u > 0 ? deformer.structure() : Deformer::Structure{};
    follow(kept, now.rest);
    if (span.u > 0) deformer.start_from(blended({here, *from.pose}, {there, *to.pose}, span.u, deformer.structure()));
  } else if (now.pose == nullptr || canonical) {
    follow(kept, now.rest);
    deformer.reset();
    const std::vector<Affine>& begin = layer.start.get();
    if (begin.size() == deformer.pose().size() && frame == footage_.frame_of(layer)) deformer.start_from(begin);
  } else if (kept.held != now.pose || kept.followed != now.rest) {
    follow(kept, now.rest);
    deformer.start_from(*now.pose);
  }

  SolveOptions options = options_->solve;
  const bool shown = frame == frame_ && options_->on_iteration;
  if (shown) done_.push_back(result(i, now));
  options.on_iteration = [&](const Pose& pose) {
    if (shown) {
      done_.back().pose = std::make_shared<const Pose>(pose);
      if (!options_->on_iteration(done_)) return false;
    }
    return !options_->progress || options_->progress("solving", i, 0);
  };
  now.settled = false;
  now.quality = SolveOptions::Quality::Interactive;
  now.output = nullptr;
  now.report = deformer.solve(now.constraints, options);
  now.pose = kept.held = std::make_shared<const Pose>(deformer.pose());
  now.map_energy = std::make_shared<const std::vector<double>>(deformer.map_energy());
  now.settled = now.report.status != Status::Stopped;
  if (now.settled) now.quality = options_->solve.quality;
  if (shown) done_.pop_back();
  return now.settled;
}

/// What a layer asks of its rest at a frame; nothing where a callback stopped the layers below.
std::optional<Workspace::Wanted> Workspace::wanted(std::size_t i, int frame, const Shape& rest) {
  Kept& kept = kept_[i];
  const Layer& layer = layers_[i];
  if (!kept.marked)
    kept.marked = marked(layer, rest.size(), [&](const Selection& selection, bool as_written) {
      return footage_.points(layer, selection, as_written);
    });
  const std::vector<Key> keys = keys_of(layer, footage_.frame_of(layer));
  const KeySpan span = span_of(keys, frame);
  const Key &first = keys[span.first], &second = keys[span.second];
  std::shared_ptr<const Shape> rest_first, rest_second;
  if (frame != first.frame) {
    rest_first = rest_of(i, first.frame);
    rest_second = rest_of(i, second.frame);
    if (rest_first == nullptr || rest_second == nullptr) return std::nullopt;
  }
  Wanted out{{kept.marked->fixed,
              {},
              kept.marked->rigid,
              kept.marked->stiffness,
              weights_between(first.example_weights, second.example_weights, span.u)},
             {},
             {}};
  for (std::size_t h = 0; h < layer.handles.size(); ++h) {
    const std::vector<Index>& points = kept.marked->handles[h];
    std::vector<Vec3> places = handle_places(layer.handles[h], rest.origin);
    const std::vector<Vec3> now = at(points, places, rest);
    out.motions.push_back(frame == first.frame ? first.handles[h]
                                               : motion_between(first.handles[h], second.handles[h], span.u,
                                                                at(points, places, *rest_first),
                                                                at(points, places, *rest_second), now, rest.origin));
    out.constraints.handles.push_back(
        {points, targets_of(out.motions[h], now, rest.origin), std::move(places), turn_of(out.motions[h])});
    out.centres.push_back(std::accumulate(now.begin(), now.end(), Vec3(0, 0, 0)) / static_cast<double>(now.size()));
  }
  // Beyond the handles that have motions: what has none can't be taken hold of.
  if (kept.markers != nullptr)
    if (Handle driven = kept.markers->handle(frame, rest.origin); !driven.places.empty())
      out.constraints.handles.push_back(std::move(driven));
  // Where nothing pulls, there is nothing to find weights by.
  if (out.constraints.handles.empty()) {
    std::vector<std::optional<double>>& weights = out.constraints.example_weights;
    weights.resize(kept.examples.size());
    for (std::optional<double>& weight : weights) weight = weight.value_or(0);
  }
  return out;
}

/// The points that a layer works on at a frame: the output of the layers below. Null where a callback stopped them.
std::shared_ptr<const Shape> Workspace::rest_of(std::size_t i, int frame) {
  while (i > 0)
    if (layers_[--i].on) return output(i, frame);
  return footage_.carrier(frame);
}

std::shared_ptr<const Shape> Workspace::output(std::size_t i, int frame) {
  const auto known = kept_[i].solved.find(frame);
  // Layers below the one that is brought up to date are so at the frame shown; at other frames they may not be.
  const bool current = frame == frame_ && done_.size() > 0 && done_.back().layer >= i;
  if (!current && !bring(i, frame)) return nullptr;
  Solved& solved = current ? known->second : kept_[i].solved.at(frame);
  if (solved.output == nullptr) {
    const SkinWeights& own = kept_[i].deformer->weights();
    solved.output = std::make_shared<const Shape>(skin(*solved.rest, own, *solved.pose));
  }
  return solved.output;
}

void Workspace::follow(Kept& kept, const std::shared_ptr<const Shape>& rest) {
  if (kept.followed == rest) return;
  kept.deformer->follow(rest);
  kept.followed = rest;
  kept.held = nullptr;
  kept.structure = nullptr;
}

LayerResult Workspace::result(std::size_t i, const Solved& solved) {
  Kept& kept = kept_[i];
  if (kept.followed != solved.rest) follow(kept, solved.rest);
  if (kept.structure == nullptr)
    kept.structure = std::make_shared<const Deformer::Structure>(kept.deformer->structure());
  if (footage_.stream() && (kept.bound_at != solved.rest || kept.bound != points_)) {
    kept.weights = std::make_shared<const SkinWeights>(kept.deformer->bind(points_, Gradients::No));
    kept.bound = points_;
    kept.bound_at = solved.rest;
  }
  LayerResult out;
  out.layer = i;
  out.weights = kept.weights;
  out.pose = solved.pose;
  out.structure = kept.structure;
  out.report = solved.report;
  out.constraints = solved.constraints;
  out.of_frame = !footage_.stream();
  out.motions = solved.motions;
  out.centres = solved.centres;
  out.map_energy = solved.map_energy;
  out.examples = kept.examples;
  out.solved = true;
  out.build_seconds = kept.build_seconds;
  out.markers = kept.markers;
  return out;
}

/// Solutions of keys stay; of the other frames only the one shown does.
void Workspace::forget_frames() {
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    if (kept_[i].deformer == nullptr) continue;
    const std::vector<Key> keys = keys_of(kept_[i].layer, footage_.frame_of(kept_[i].layer));
    std::erase_if(kept_[i].solved, [&](const auto& row) {
      const int frame = row.first;
      return frame != frame_ && frame != footage_.frame_of(kept_[i].layer) &&
             std::none_of(keys.begin(), keys.end(), [&](const Key& key) { return key.frame == frame; });
    });
  }
}

}  // namespace sinew::document
