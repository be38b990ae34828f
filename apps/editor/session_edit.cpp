#include <fmt/core.h>

#include <algorithm>
#include <numbers>
#include <numeric>

#include "apps/editor/session.h"
#include "engine/document/settings.h"

namespace sinew::editor {

namespace {

using document::Layer;
using document::Project;

std::string counted(const char* what, std::size_t points) {
  return fmt::format("{} {} point{}", what, points, points == 1 ? "" : "s");
}

/// What a mark is called as a step of history.
const char* step_of(Mark mark) {
  switch (mark) {
    case Mark::Fixed: return "Fix";
    case Mark::Handle: return "Handle of";
    case Mark::Rigid: return "Make rigid";
    case Mark::Stiffer: return "Stiffen";
    case Mark::Softer: return "Soften";
    case Mark::Free: break;
  }
  return "Free";
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
  retime();
  const std::size_t layers = project().layers.size();
  if (layer_ >= layers) layer_ = layers == 0 ? 0 : layers - 1;
  const std::size_t handles = layers == 0 ? 0 : project().layers[layer_].handles.size();
  if (handle_ && *handle_ >= handles) handle_.reset();
  layer_points_.reset();
  handle_centres_.reset();
  residuals_.reset();
  marks_ready_ = false;
  dirty_ = !(project() == saved_);
  if (journal_ != nullptr && has_input()) journal_->note(history_);
  changed_.project = changed_.marks = true;
}

// Selection

void Session::selection_changed() {
  marks_ready_ = false;
  changed_.marks = true;
}

void Session::select(const PointSet& touched, SelectMode mode) {
  if (!has_input() || touched.size() != selection_.size()) return;  // of a shape that is gone
  // Points that are not finite are nowhere, and hidden ones are left alone by all that reaches through.
  selection_ = intersected(combined(selection_, touched, mode), selectable());
  selection_changed();
}

void Session::select_all() {
  if (!has_input()) return;
  selection_ = selectable();
  selection_changed();
}

void Session::select_none() {
  if (!has_input()) return;
  selection_.clear();
  selection_changed();
}

void Session::invert_selection() {
  if (!has_input()) return;
  selection_ = inverted(selection_, selectable());
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
    selection_ = intersected(grown(selection_, *neighbourhood_), selectable());
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
    selection_ = intersected(connected(selection_, *neighbourhood_), selectable());
    selection_changed();
  });
}

void Session::select_handle(std::size_t handle) {
  if (!has_input() || handle >= layer_points().handles.size()) return;
  selection_ = intersected(PointSet(input_->size(), layer_points().handles[handle]), selectable());
  selection_changed();
}

void Session::select_points(const std::vector<std::vector<Index>>& lists) {
  selection_.clear();
  for (const std::vector<Index>& points : lists)
    selection_ = combined(selection_, PointSet(input_->size(), points), SelectMode::Add);
  selection_ = intersected(selection_, selectable());
  selection_changed();
}

void Session::select_fixed() {
  if (has_input()) select_points(layer_points().fixed);
}

void Session::select_rigid() {
  if (has_input()) select_points(layer_points().rigid);
}

void Session::select_stiff() {
  if (has_input()) select_points(layer_points().stiff);
}

// Marks

/// How the selected points have moved, so that they stay where they are. What was a handle that has been turned by more
/// than half a turn goes on from there.
document::Motion Session::motion_of_new_handle() {
  const std::vector<Index> points = selection_.indices();
  const std::vector<Vec3> from = bent(*input_, shown_, layer_, points);
  const document::Motion fitted =
      rigid_fit(from, bent(*input_, shown_, layer_ + 1, points), 1e-7 * bounds_.diagonal(), input_->origin);
  if (layer() == nullptr) return fitted;
  const std::vector<std::vector<Index>>& handles = layer_points().handles;
  std::size_t most = 0, of = 0;
  for (std::size_t h = 0; h < handles.size(); ++h) {
    const auto shared = static_cast<std::size_t>(
        std::count_if(handles[h].begin(), handles[h].end(), [&](Index i) { return selection_[i]; }));
    if (shared <= most) continue;
    most = shared;
    of = h;
  }
  if (most == 0) return fitted;
  document::Motion own = motion_now(of);
  if (most == points.size() && (own.rotate || own.matrix)) {  // part of a handle moves as it did
    if (own.rotate && !own.rotate->about) own.rotate->about = handle_rest_centres()[of] + input_->origin;
    return own;
  }
  const std::optional<Vec3> turn = document::turn_of(own);
  if (!turn || !own.rotate) return fitted;
  const Vec3 centre = std::accumulate(from.begin(), from.end(), Vec3(0, 0, 0)) / static_cast<double>(from.size());
  return wound(fitted, *turn * (180 / std::numbers::pi), centre, input_->origin);
}

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
  const document::Motion motion = mark == Mark::Handle ? motion_of_new_handle() : document::Motion{};
  if (this->layer() != nullptr) {
    if (!moves()) layer = with_pivots(layer, handle_rest_centres(), input_->origin);
    layer = marked(layer, layer_points(), selection_, mark, motion, frame);
  } else {
    layer = marked(layer, {}, selection_, mark, motion, frame);
  }
  forget_starts(project, layer_ + 1);
  if (!refuse([&] { document::check_layers(project.layers, methods_); })) return;
  apply(std::move(project), counted(step_of(mark), selection_.count()));
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
  if (!refuse([&] { document::check_layers(project.layers, methods_); })) return;
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
