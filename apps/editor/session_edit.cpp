#include <fmt/core.h>

#include <algorithm>

#include "apps/editor/session.h"
#include "engine/document/settings.h"

namespace sinew::editor {

namespace {

using document::Layer;
using document::Project;

/// The pose that a layer starts from holds only for the structure that it was found with, and that follows from the
/// layer's own settings and from all below it.
void forget_starts(Project& project, std::size_t from) {
  for (std::size_t i = from; i < project.layers.size(); ++i) project.layers[i].start = {};
}

std::string counted(const char* what, std::size_t points) {
  return fmt::format("{} {} point{}", what, points, points == 1 ? "" : "s");
}

}  // namespace

Layer Session::standard_layer() const {
  Layer layer;
  layer.name = "Layer 1";
  layer.method = methods_.front().name;
  if (stream_) {
    layer.path.emplace();
    layer.path->every = std::max(1, static_cast<int>(frames().size()) / 24);
  }
  return layer;
}

void Session::apply(Project project, const std::string& label) {
  if (project == history_.present()) return;
  history_.commit(std::move(project), label);
  project_changed();
  settling_.reset();
  ask(SolveOptions::Quality::Final, history_.present());
}

/// After any change of what project() is.
void Session::project_changed() {
  const std::size_t layers = project().layers.size();
  if (layer_ >= layers) layer_ = layers == 0 ? 0 : layers - 1;
  const std::size_t handles = layers == 0 ? 0 : project().layers[layer_].handles.size();
  if (handle_ && *handle_ >= handles) handle_.reset();
  layer_points_.reset();
  handle_centres_.reset();
  marks_ready_ = false;
  dirty_ = !(project() == saved_);
  changed_.project = changed_.marks = true;
}

// Selection

void Session::selection_changed() {
  marks_ready_ = false;
  changed_.marks = true;
}

void Session::select(const PointSet& touched, SelectMode mode) {
  if (!has_input() || touched.size() != selection_.size()) return;  // of a shape that is gone
  // Points that are not finite are nowhere: nothing touches them but a caller's mistake.
  selection_ = intersected(combined(selection_, touched, mode), finite_);
  selection_changed();
}

void Session::select_all() {
  if (!has_input()) return;
  selection_ = finite_;
  selection_changed();
}

void Session::select_none() {
  if (!has_input()) return;
  selection_.clear();
  selection_changed();
}

void Session::invert_selection() {
  if (!has_input()) return;
  selection_ = inverted(selection_, finite_);
  selection_changed();
}

void Session::with_neighbourhood(std::function<void()> then) {
  if (!has_input()) return;
  if (neighbourhood_ != nullptr) {
    then();
    return;
  }
  after_neighbourhood_.push_back(std::move(then));
  start_waiting();
}

void Session::grow_selection() {
  with_neighbourhood([this] {
    selection_ = grown(selection_, *neighbourhood_);
    selection_changed();
  });
}

void Session::shrink_selection() {
  with_neighbourhood([this] {
    selection_ = shrunk(selection_, *neighbourhood_);
    selection_changed();
  });
}

void Session::select_connected() {
  with_neighbourhood([this] {
    selection_ = connected(selection_, *neighbourhood_);
    selection_changed();
  });
}

void Session::select_handle(std::size_t handle) {
  if (!has_input() || handle >= layer_points().handles.size()) return;
  selection_ = PointSet(input_->size(), layer_points().handles[handle]);
  selection_changed();
}

void Session::select_fixed() {
  if (!has_input()) return;
  selection_.clear();
  for (const std::vector<Index>& points : layer_points().fixed)
    selection_ = combined(selection_, PointSet(input_->size(), points), SelectMode::Add);
  selection_changed();
}

// Marks

void Session::mark_selection(Mark mark) {
  if (!has_input()) return;
  if (selection_.empty()) {
    notify(Severity::Hint, "Select points first.");
    return;
  }
  cancel_drag();
  Project project = history_.present();
  if (project.layers.empty()) {
    if (mark == Mark::Free) return;
    project.layers.push_back(standard_layer());
  }
  Layer& layer = project.layers[layer_];
  const std::optional<int> frame = stream_ ? std::optional(frame_) : std::nullopt;
  document::Motion motion;
  if (mark == Mark::Handle) {
    const std::vector<Index> points = selection_.indices();
    motion = rigid_fit(bent(*input_, shown_, layer_, points), bent(*input_, shown_, layer_ + 1, points),
                       1e-7 * bounds_.diagonal(), input_->origin);
  }
  if (this->layer() != nullptr) {
    if (!moves()) layer = with_pivots(layer, handle_rest_centres(), input_->origin);
    layer = marked(layer, layer_points(), selection_, mark, motion, frame);
  } else {
    layer = marked(layer, {}, selection_, mark, motion, frame);
  }
  forget_starts(project, layer_ + 1);
  const char* what = mark == Mark::Fixed ? "Fix" : mark == Mark::Handle ? "Handle of" : "Free";
  apply(std::move(project), counted(what, selection_.count()));
  if (mark == Mark::Handle) handle_ = history_.present().layers[layer_].handles.size() - 1;
}

void Session::delete_handle(std::size_t handle) {
  cancel_drag();
  if (layer() == nullptr || handle >= layer()->handles.size()) return;
  Project project = history_.present();
  project.layers[layer_] = without_handle(project.layers[layer_], handle);
  forget_starts(project, layer_ + 1);
  handle_.reset();
  apply(std::move(project), "Delete handle");
}

void Session::reset_handle(std::size_t handle) {
  cancel_drag();
  if (layer() == nullptr || handle >= layer()->handles.size()) return;
  Project project = history_.present();
  if (keyed()) project.layers[layer_] = keyed_here();
  document::Motion& motion = motion_at(project.layers[layer_], handle, frame_);
  motion = {};
  motion.move = Vec3(0, 0, 0);
  forget_starts(project, layer_);
  apply(std::move(project), "Reset handle");
}

// Layers

void Session::add_cut(std::span<const Vec3> path, const Vec3& depth) {
  if (!has_input() || path.size() < 2) return;
  cancel_drag();
  Project project = history_.present();
  if (project.layers.empty()) project.layers.push_back(standard_layer());
  document::CutEdit cut;
  for (const Vec3& p : path) cut.path.push_back(p + input_->origin);
  cut.depth = depth;
  project.layers[layer_].cuts.push_back(std::move(cut));
  forget_starts(project, layer_);
  apply(std::move(project), "Cut");
}

void Session::remove_cut() {
  if (layer() == nullptr || layer()->cuts.empty()) return;
  cancel_drag();
  Project project = history_.present();
  project.layers[layer_].cuts.pop_back();
  forget_starts(project, layer_);
  apply(std::move(project), "Remove cut");
}

void Session::choose_layer(std::size_t layer) {
  cancel_drag();
  if (layer >= project().layers.size() || layer == layer_) return;
  layer_ = layer;
  handle_.reset();
  project_changed();
}

void Session::add_layer(const std::string& method) {
  if (!has_input()) return;
  cancel_drag();
  Project project = history_.present();
  Layer layer = standard_layer();
  layer.name = fmt::format("Layer {}", project.layers.size() + 1);
  layer.method = method;
  if (!refuse([&] { document::method_of(layer, methods_); })) return;
  project.layers.push_back(layer);
  layer_ = project.layers.size() - 1;
  handle_.reset();
  apply(std::move(project), "Add layer");
}

void Session::remove_layer(std::size_t layer) {
  cancel_drag();
  Project project = history_.present();
  if (layer >= project.layers.size()) return;
  project.layers.erase(project.layers.begin() + static_cast<std::ptrdiff_t>(layer));
  forget_starts(project, layer);
  if (layer_ > layer || layer_ == project.layers.size()) layer_ = layer_ == 0 ? 0 : layer_ - 1;
  handle_.reset();
  apply(std::move(project), "Remove layer");
}

void Session::move_layer(std::size_t layer, int by) {
  cancel_drag();
  Project project = history_.present();
  const std::size_t other = by > 0 ? layer + 1 : layer - 1;  // wraps below the first
  if (layer >= project.layers.size() || other >= project.layers.size()) return;
  std::swap(project.layers[layer], project.layers[other]);
  forget_starts(project, std::min(layer, other));
  layer_ = other;
  handle_.reset();
  apply(std::move(project), by > 0 ? "Raise layer" : "Lower layer");
}

void Session::rename_layer(std::size_t layer, const std::string& name) {
  cancel_drag();
  Project project = history_.present();
  if (layer >= project.layers.size()) return;
  project.layers[layer].name = name;
  apply(std::move(project), "Rename layer");
}

void Session::toggle_layer(std::size_t layer) {
  cancel_drag();
  Project project = history_.present();
  if (layer >= project.layers.size()) return;
  project.layers[layer].on = !project.layers[layer].on;
  forget_starts(project, layer + 1);
  apply(std::move(project), project.layers[layer].on ? "Show layer" : "Hide layer");
}

void Session::set_method(std::size_t layer, const std::string& method) {
  cancel_drag();
  Project project = history_.present();
  if (layer >= project.layers.size() || project.layers[layer].method == method) return;
  project.layers[layer].method = method;
  project.layers[layer].settings.clear();
  forget_starts(project, layer);
  if (refuse([&] { document::check_layers(project.layers, methods_); })) apply(std::move(project), "Change method");
}

void Session::set_setting(std::size_t layer, const std::string& name, const std::variant<double, std::string>& value) {
  cancel_drag();
  Project project = history_.present();
  if (layer >= project.layers.size()) return;
  Layer& changed = project.layers[layer];
  std::erase_if(changed.settings, [&](const document::SettingEdit& edit) { return edit.name == name; });
  const Layer standard = changed;
  changed.settings.push_back({name, value, {}});
  forget_starts(project, layer);
  const bool fine = refuse([&] {
    const Method& method = document::method_of(changed, methods_);
    const double given = value_of(document::settings_of(changed, method), method.settings, name);
    if (given == value_of(document::settings_of(standard, method), method.settings, name))
      changed.settings = standard.settings;
  });
  if (fine) apply(std::move(project), "Set " + name);
}

double Session::setting(std::size_t layer, const Setting& setting) const {
  double out = setting.standard;
  if (layer >= project().layers.size()) return out;
  const Layer& of = project().layers[layer];
  // A setting that can't be understood was refused when it was given.
  sentence_of_failure([&] {
    const Method& method = document::method_of(of, methods_);
    out = value_of(document::settings_of(of, method), method.settings, setting.name);
  });
  return out;
}

// History

void Session::undo() {
  go_to(history_.position() == 0 ? 0 : history_.position() - 1);
}

void Session::redo() {
  go_to(std::min(history_.position() + 1, history_.size() - 1));
}

void Session::go_to(std::size_t state) {
  cancel_drag();
  if (!has_input() || state >= history_.size() || state == history_.position()) return;
  history_.go_to(state);
  settling_.reset();
  project_changed();
  ask(SolveOptions::Quality::Final, history_.present());
}

}  // namespace sinew::editor
