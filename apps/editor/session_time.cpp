#include <algorithm>
#include <cmath>

#include "apps/editor/session.h"

namespace sinew::editor {

namespace {

using document::Layer;
using document::Project;

/// The index of the frame nearest to `frame`.
std::size_t nearest_frame(std::span<const int> frames, int frame) {
  const auto above = std::lower_bound(frames.begin(), frames.end(), frame);
  if (above == frames.end()) return frames.size() - 1;
  const auto index = static_cast<std::size_t>(above - frames.begin());
  return index > 0 && frame - frames[index - 1] < frames[index] - frame ? index - 1 : index;
}

/// Selections that were made at the layer's frame say so, before that becomes another.
void with_places(Layer& layer, int frame) {
  const auto place = [&](document::Selection& selection) { selection.frame = selection.frame.value_or(frame); };
  for (document::Selection& selection : layer.nodes) place(selection);
  for (document::Selection& selection : layer.fixed) place(selection);
  for (document::HandleEdit& handle : layer.handles) place(handle.points);
  for (document::Selection& selection : layer.rigid) place(selection);
  for (document::Stiffness& stiffness : layer.stiffness) place(stiffness.points);
}

double step_of(double rate) {
  return rate > 0 ? 1 / rate : 1.0 / 24;
}

}  // namespace

std::pair<int, int> Session::play_range() const {
  if (!moves()) return {frame_, frame_};
  const int first = frames().front(), last = frames().back();
  if (!range_ || range_->first > last || range_->second < first || range_->first >= range_->second)
    return {first, last};
  return {std::max(first, range_->first), std::min(last, range_->second)};
}

void Session::go_to_frame(int frame) {
  if (!moves()) return;
  end_drag();  // what was dragged so far is kept
  const int wanted = frames()[nearest_frame(frames(), frame)];
  if (wanted == wanted_frame_) return;
  wanted_frame_ = wanted;
  answered_ = false;
  ask(SolveOptions::Quality::Interactive, project());
}

void Session::step_frame(int by) {
  if (!moves()) return;
  play(false);
  const auto last = static_cast<int>(frames().size()) - 1;
  const int index = static_cast<int>(nearest_frame(frames(), wanted_frame_)) + by;
  go_to_frame(frames()[static_cast<std::size_t>(std::clamp(index, 0, last))]);
}

void Session::step_key(int by) {
  if (!moves() || layer() == nullptr) return;
  play(false);
  std::optional<int> to;
  for (const document::Key& key : layer()->keys) {
    if (by < 0 && key.frame < wanted_frame_) to = key.frame;
    if (by > 0 && key.frame > wanted_frame_ && !to) to = key.frame;
  }
  if (to) go_to_frame(*to);
}

void Session::play(bool on) {
  if (on == playing_ || (on && !moves())) return;
  end_drag();
  playing_ = on;
  changed_.project = true;
  if (!on) {
    answered_ = false;
    ask(SolveOptions::Quality::Final, project());
    return;
  }
  // From the end of the range, and from beyond it, it begins again.
  const auto [first, last] = play_range();
  if (wanted_frame_ >= last || wanted_frame_ < first) go_to_frame(first);
  play_from_ = nearest_frame(frames(), wanted_frame_);
  play_began_ = seconds_now();
}

double Session::next_step() const {
  if (!playing_ || frame_ != wanted_frame_) return -1;
  const auto shown = static_cast<double>(nearest_frame(frames(), frame_)) - static_cast<double>(play_from_);
  return std::max(0.0, play_began_ + (shown + 1) * step_of(rate()) - seconds_now());
}

/// Plays on: asks for the frame whose time it is once the one before is there, so that slow ones are passed over.
void Session::advance() {
  if (!playing_ || frame_ != wanted_frame_ || !has_input()) return;
  const double now = seconds_now();
  std::size_t index = play_from_ + static_cast<std::size_t>(std::max(0.0, (now - play_began_) / step_of(rate())));
  const auto [first, last] = play_range();
  if (index > nearest_frame(frames(), last)) {
    if (!loop_) {
      play(false);
      return;
    }
    index = play_from_ = nearest_frame(frames(), first);
    play_began_ = now;
  }
  if (frames()[index] == frame_) return;
  wanted_frame_ = frames()[index];
  ask(SolveOptions::Quality::Interactive, project());
}

/// An answer for a frame. Its shape takes the place of the one shown; the final answer follows where nothing else does.
void Session::show_frame(document::SolveAnswer answer) {
  if (answer.shape != input_) {
    const bool same_points = answer.shape->size() == input_->size() && !stream_;
    input_ = answer.shape;
    changed_.frame = true;
    bent_ready_ = false;
    if (!same_points) {
      selection_ = hidden_ = PointSet(input_->size());
      finite_ = finite_points(input_->positions);
      selector_ = std::make_shared<document::Selector>(input_);
      neighbourhood_.reset();
    }
    if (stream_) layer_points_.reset();
    marks_ready_ = false;
    changed_.marks = true;
  }
  frame_ = answer.frame;
  handle_centres_.reset();
  const bool final_quality = answer.final_quality;
  show_answer(std::move(answer.layers));
  changed_.project = true;
  answered_ = final_quality;
  if (!final_quality && !playing_) ask(SolveOptions::Quality::Final, project());
}

void Session::insert_key() {
  if (layer() == nullptr || (layer()->handles.empty() && layer()->examples.empty())) {
    notify(Severity::Hint, "A key holds where the handles of a layer are: make a handle first.");
    return;
  }
  cancel_drag();
  Project project = history_.present();
  project.layers[layer_] = keyed_here();
  apply(std::move(project), "Key at " + std::to_string(frame_));
}

void Session::delete_key(int frame) {
  if (layer() == nullptr) return;
  cancel_drag();
  Project project = history_.present();
  Layer& layer = project.layers[layer_];
  const int base = base_frame(layer, frames().front());
  // The last key's motions become the handles' own: the edit stays what it was there.
  if (layer.keys.size() == 1 && layer.keys[0].frame == frame) {
    for (std::size_t h = 0; h < layer.keys[0].handles.size(); ++h) layer.handles[h].motion = layer.keys[0].handles[h];
    if (!layer.keys[0].example_weights.empty()) layer.example_weights = layer.keys[0].example_weights;
    with_places(layer, base);
    layer.frame = frame;
  } else {
    layer.frame = base;
  }
  std::erase_if(layer.keys, [&](const document::Key& key) { return key.frame == frame; });
  apply(std::move(project), "Delete key at " + std::to_string(frame));
}

void Session::move_key(int frame, int to) {
  if (layer() == nullptr || frame == to) return;
  cancel_drag();
  Project project = history_.present();
  project.layers[layer_].frame = base_frame(*layer(), frames().front());
  std::vector<document::Key>& keys = project.layers[layer_].keys;
  const auto key = std::find_if(keys.begin(), keys.end(), [&](const document::Key& k) { return k.frame == frame; });
  if (key == keys.end()) return;
  document::Key moved = *key;
  moved.frame = to;
  keys.erase(key);
  std::erase_if(keys, [&](const document::Key& k) { return k.frame == to; });
  keys.insert(std::find_if(keys.begin(), keys.end(), [&](const document::Key& k) { return k.frame > to; }), moved);
  apply(std::move(project), "Move key to " + std::to_string(to));
}

void Session::set_interpolation(int frame, document::Interpolation interpolation) {
  if (layer() == nullptr) return;
  cancel_drag();
  Project project = history_.present();
  for (document::Key& key : project.layers[layer_].keys)
    if (key.frame == frame) key.interpolation = interpolation;
  apply(std::move(project), "Change interpolation");
}

}  // namespace sinew::editor
