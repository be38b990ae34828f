#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <numeric>

#include "apps/editor/session.h"

namespace sinew::editor {

namespace {

using document::LayerResult;
using document::Project;

/// Lengths in units of the diagonal. Where the answer from rest is no farther than this from what the drag showed,
/// nobody sees a change; an interactive answer differs from the final one by about 0.003.
constexpr double seen = 0.01;
/// Two final answers nearer than this are the same minimum.
constexpr double same_minimum = 1e-3;

/// The largest distance between two bendings of a shape, over a sample of its points.
double distance_between(const Shape& input, std::span<const LayerResult> a, std::span<const LayerResult> b,
                        std::size_t layers) {
  std::vector<Index> sample;
  for (std::size_t i = 0; i < input.size(); i += sample_stride(input.size()))
    if (input.positions[i].allFinite()) sample.push_back(static_cast<Index>(i));
  const std::vector<Vec3> p = bent(input, a, layers, sample), q = bent(input, b, layers, sample);
  double out = 0;
  for (std::size_t i = 0; i < p.size(); ++i) out = std::max(out, (p[i] - q[i]).norm());
  return out;
}

const LayerResult* result_of(std::span<const LayerResult> layers, std::size_t layer) {
  const auto found = std::find_if(layers.begin(), layers.end(), [&](const auto& l) { return l.layer == layer; });
  return found == layers.end() ? nullptr : &*found;
}

Vec3 mean_of(std::span<const Vec3> points) {
  if (points.empty()) return Vec3(0, 0, 0);
  return std::accumulate(points.begin(), points.end(), Vec3(0, 0, 0)) / static_cast<double>(points.size());
}

}  // namespace

const document::LayerResult* Session::shown_layer() const {
  return result_of(shown_, layer_);
}

/// Whether drags of the chosen layer set keys: what moves is edited at a pose.
bool Session::keyed() const {
  return layer() != nullptr && (!layer()->keys.empty() || (moves() && !stream_));
}

/// The motion of a handle at the frame shown, with the drag that runs.
document::Motion Session::motion_now(std::size_t handle) const {
  const document::Layer& now = drag_ ? drag_->now.layers[layer_] : *layer();
  const bool at_key =
      std::any_of(now.keys.begin(), now.keys.end(), [&](const document::Key& key) { return key.frame == frame_; });
  const document::LayerResult* shown = shown_layer();
  if (!at_key && moves() && shown != nullptr && handle < shown->motions.size()) return shown->motions[handle];
  return motion_at(now, handle, frame_);
}

/// The chosen layer with a key at the frame shown that changes nothing. `of_weights`: the weights of its examples will
/// be set there; those that it has without keys then hold at its own frame, like the motion of a handle.
document::Layer Session::keyed_here(bool of_weights) const {
  std::vector<document::Motion> motions;
  for (std::size_t h = 0; h < layer()->handles.size(); ++h) motions.push_back(motion_now(h));
  document::Layer out = *layer();
  const bool weighted = std::any_of(out.keys.begin(), out.keys.end(),
                                    [](const document::Key& key) { return !key.example_weights.empty(); });
  const bool pinned = std::any_of(out.example_weights.begin(), out.example_weights.end(),
                                  [](const auto& weight) { return weight.has_value(); });
  if (of_weights && pinned && out.keys.empty()) {
    std::vector<document::Motion> own;
    for (const document::HandleEdit& handle : out.handles) own.push_back(handle.motion);
    out = with_key(out, base_frame(out, frames().front()), frames().front(), own);
  }
  const std::vector<std::optional<double>> weights = asked_weights();
  out = with_key(out, frame_, frames().front(), motions);
  for (document::Key& key : out.keys)
    if (weighted && key.frame == frame_) key.example_weights = weights;
  return out;
}

/// Means of the handles' points where the chosen layer starts from.
const std::vector<Vec3>& Session::handle_rest_centres() {
  if (moves()) {
    const document::LayerResult* shown = shown_layer();
    const std::size_t count = layer() == nullptr ? 0 : layer()->handles.size();
    handle_centres_ = shown != nullptr ? shown->centres : std::vector<Vec3>{};
    // A handle that the newest answer does not know yet is where its points are.
    for (std::size_t h = handle_centres_->size(); h < count; ++h)
      handle_centres_->push_back(mean_of(bent(*input_, shown_, layer_, layer_points().handles[h])));
    handle_centres_->resize(count, Vec3(0, 0, 0));
  } else if (!handle_centres_) {
    std::vector<Vec3> centres;
    for (const std::vector<Index>& points : layer_points().handles)
      centres.push_back(mean_of(bent(*input_, shown_, layer_, points)));
    handle_centres_ = std::move(centres);
  }
  return *handle_centres_;
}

std::vector<HandleView> Session::handles() {
  std::vector<HandleView> out;
  if (layer() == nullptr || !has_input()) return out;
  const std::vector<Vec3>& centres = handle_rest_centres();
  for (std::size_t h = 0; h < centres.size(); ++h) {
    const document::Motion motion = motion_now(h);
    HandleView view;
    view.points = layer_points().handles[h].size();
    if (const std::vector<Vec3>& to = motion.to.get(); !to.empty())
      view.target = mean_of(to) - input_->origin;
    else
      view.target = document::targets_of(motion, std::span(&centres[h], 1), input_->origin).front();
    if (motion.rotate)
      view.axes =
          Eigen::AngleAxisd(motion.rotate->degrees * (std::numbers::pi / 180), motion.rotate->axis.stableNormalized());
    out.push_back(view);
  }
  return out;
}

bool Session::begin_drag(std::size_t handle) {
  end_drag();
  if (layer() == nullptr || handle >= layer()->handles.size() || !layer()->on) return false;
  handle_ = handle;
  Drag drag = drag_from_here();
  drag.handle = handle;
  drag.before = motion_now(handle);
  if (keyed()) drag.now.layers[layer_] = keyed_here();
  drag.centre = handle_rest_centres()[handle];
  drag_ = std::move(drag);
  return true;
}

Session::Drag Session::drag_from_here() {
  play(false);
  wanted_frame_ = frame_;  // what is shown is dragged, not what is on its way
  Drag out;
  out.now = project();
  out.first_ticket = ticket_ + 1;
  out.shown = shown_;
  out.settling = std::exchange(settling_, std::nullopt);
  out.unsettled = !answered_;
  return out;
}

void Session::drag_to(const Transform& motion) {
  if (!drag_ || drag_->example) return;
  document::Motion& now = motion_at(drag_->now.layers[layer_], drag_->handle, frame_);
  const document::Motion wanted = moved(drag_->before, motion, drag_->centre, input_->origin);
  if (wanted == now) return;
  now = wanted;
  drag_->moved = true;
  ask(SolveOptions::Quality::Interactive, drag_->now);
}

void Session::end_drag() {
  if (!drag_) return;
  Drag drag = std::move(*std::exchange(drag_, std::nullopt));
  if (!drag.moved || drag.now == project()) {
    resume(std::move(drag));
    return;
  }
  // First as if there had been no drag: usually that ends in the same place, and the file stays small.
  for (std::size_t i = layer_; i < drag.now.layers.size(); ++i) drag.now.layers[i].start = {};
  history_.commit(std::move(drag.now), drag.label);
  project_changed();
  // What moves begins at its keys, which are all that a file has.
  if (!moves()) settling_ = Settling{Settling::Step::FromRest, layer_, shown_, {}, {}};
  ask(SolveOptions::Quality::Final, project());
}

void Session::cancel_drag() {
  if (!drag_) return;
  Drag drag = std::move(*std::exchange(drag_, std::nullopt));
  if (drag.moved) show_answer(drag.shown);
  resume(std::move(drag));
}

/// After a drag that changed nothing: what it interrupted goes on.
void Session::resume(Drag drag) {
  settling_ = std::move(drag.settling);
  if (settling_) settling_->step = Settling::Step::FromRest;
  if (drag.moved || drag.unsettled || settling_) ask(SolveOptions::Quality::Final, project());
}

/// A final answer: shown, or, on the way from a drag to its canonical answer, compared.
void Session::settle(std::vector<LayerResult> layers) {
  if (!settling_) {
    show_answer(std::move(layers));
    return;
  }
  const double diagonal = std::max(bounds_.diagonal(), 1e-300);
  const std::size_t end = settling_->layer + 1;
  if (settling_->step == Settling::Step::FromRest) {
    const LayerResult* dragged = result_of(settling_->dragged, settling_->layer);
    const LayerResult* rested = result_of(layers, settling_->layer);
    const bool comparable = dragged != nullptr && rested != nullptr && dragged->pose != nullptr &&
                            dragged->pose->size() == rested->pose->size();
    if (!comparable || distance_between(*input_, settling_->dragged, layers, end) <= seen * diagonal) {
      settling_.reset();
      show_answer(std::move(layers));
      return;
    }
    settling_->step = Settling::Step::FromDrag;
    settling_->from_rest = std::move(layers);
    settling_->project = project();
    settling_->project.layers[settling_->layer].start = document::Shared<Affine>(*dragged->pose);
    ask(SolveOptions::Quality::Final, settling_->project);
    return;
  }
  const Settling settling = std::move(*std::exchange(settling_, std::nullopt));
  if (distance_between(*input_, settling.from_rest, layers, end) <= same_minimum * diagonal) {
    show_answer(settling.from_rest);
    return;
  }
  // The drag's own minimum: its state of history becomes the one that says so.
  const std::string label = history_.label(history_.position());
  history_.undo();
  history_.commit(settling.project, label);
  project_changed();
  show_answer(std::move(layers));
}

}  // namespace sinew::editor
