#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "apps/editor/session.h"
#include "engine/document/settings.h"
#include "engine/io/io.h"

namespace sinew::editor {

namespace {

using document::Layer;
using document::Markers;
using document::MarkersEdit;
using document::Project;

std::string name_of(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

/// The names of methods that markers can drive: "tet".
std::string names_of_driven(std::span<const Method> methods) {
  std::string out;
  for (const Method& method : methods)
    if (method.parts.places) out += (out.empty() ? "" : " or ") + method.name;
  return out;
}

}  // namespace

std::vector<std::string> notes_of(const Markers& markers) {
  constexpr std::size_t most = 3;
  const std::string name = name_of(markers.edit().path);
  const std::vector<std::string>& notes = markers.notes();
  std::vector<std::string> out;
  for (std::size_t i = 0; i < std::min(most, notes.size()); ++i) out.push_back(name + ": " + notes[i]);
  if (notes.size() > most)
    out.push_back(fmt::format("{}: {} more such notes, which `sinew info` lists.", name, notes.size() - most));
  return out;
}

/// The layer that a motion is for: the chosen one; a new one where there is none yet. Nothing where it can't be driven.
std::optional<Layer> Session::layer_to_drive(const std::string& path) {
  const std::string is_motion = name_of(path) + " is a motion";
  if (!has_input()) {
    notify(Severity::Error, is_motion + ": open the shape that it is to drive before it.");
    return std::nullopt;
  }
  Layer out = layer() != nullptr ? *layer() : standard_layer();
  const auto driven = std::find_if(methods_.begin(), methods_.end(), [](const Method& m) { return m.parts.places; });
  if (layer() == nullptr && driven != methods_.end()) out.method = driven->name;
  if (const Method* method = layer() != nullptr ? this->method() : nullptr;
      method != nullptr && !method->parts.places) {
    notify(Severity::Error, fmt::format("{}, which drives a layer of the method {}: this layer's is {}.", is_motion,
                                        names_of_driven(methods_), method->name));
    return std::nullopt;
  }
  return out;
}

/// Matches that the layer has stay: they fit another take of the same markers as well.
void Session::open_motion(const std::string& path) {
  const std::optional<Layer> layer = layer_to_drive(path);
  if (!layer) return;
  const Bounds bounds{bounds_.min + input_->origin, bounds_.max + input_->origin};
  const auto work = [this, path, bounds, input = input_, old = layer->markers](const Tell& tell) -> Background::Finish {
    MarkersEdit edit = old ? *old : document::markers_over(path, bounds);
    edit.path = path;
    edit.place = {};
    const auto markers = std::make_shared<const Markers>(edit, *input);
    if (!tell(1)) throw io::Cancelled{};
    return [this, markers, input] {
      if (input == input_) take_motion(*markers);
    };
  };
  background_->start("Reading " + name_of(path), true, work);
}

void Session::take_motion(const Markers& markers) {
  const MarkersEdit& edit = markers.edit();
  std::optional<Layer> layer = layer_to_drive(edit.path);
  if (!layer) return;
  cancel_drag();
  layer->markers = edit;
  motions_[edit.path] = markers.time();
  Project project = history_.present();
  if (project.layers.empty()) project.layers.emplace_back();
  project.layers[layer_] = std::move(*layer);
  forget_starts(project, layer_);
  if (!refuse([&] { document::check_layers(project.layers, methods_); })) return;
  apply(std::move(project), "Motion " + name_of(edit.path));
  for (const std::string& note : notes_of(markers)) notify(Severity::Info, note);
  if (edit.matches.empty())
    notify(Severity::Info,
           name_of(edit.path) +
               " lies over the shape by its size alone, because the layer has no \"matches\": set Scale, "
               "Turn and Move until the markers stand where they belong.");
}

void Session::set_markers(const MarkersEdit& edit) {
  if (layer() == nullptr || !layer()->markers) return;
  cancel_drag();
  Project project = history_.present();
  project.layers[layer_].markers = edit;
  forget_starts(project, layer_);
  apply(std::move(project), "Align motion");
}

void Session::remove_markers() {
  if (layer() == nullptr || !layer()->markers) return;
  cancel_drag();
  Project project = history_.present();
  project.layers[layer_].markers.reset();
  forget_starts(project, layer_);
  apply(std::move(project), "Remove motion");
}

/// A still gets the frames of the motion that drives a layer, and is one again where none does.
void Session::retime() {
  if (source_ == nullptr) return;
  const MarkersEdit* driving = source_->frames.size() > 1 ? nullptr : document::driving_markers(project().layers);
  const auto known = driving == nullptr ? motions_.end() : motions_.find(driving->path);
  const std::string driven_by = known == motions_.end() ? std::string() : known->first;
  if (driven_by == driven_by_) return;
  driven_by_ = driven_by;
  sequence_ = driven_by.empty() ? source_ : std::make_shared<const Sequence>(over_time(*source_, known->second));
  playing_ = false;
  if (!std::binary_search(frames().begin(), frames().end(), frame_)) frame_ = frames().front();
  wanted_frame_ = frame_;
}

const Markers* Session::markers() const {
  const document::LayerResult* shown = shown_layer();
  return shown == nullptr ? nullptr : shown->markers.get();
}

std::vector<Markers::Picture> Session::marker_pictures() const {
  std::vector<Markers::Picture> out;
  if (!has_input()) return out;
  for (const document::LayerResult& layer : shown_)
    if (layer.markers != nullptr) out.push_back(layer.markers->picture(frame_, input_->origin));
  return out;
}

}  // namespace sinew::editor
