#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "apps/editor/session.h"
#include "engine/document/examples.h"
#include "engine/document/keys.h"
#include "engine/document/settings.h"
#include "engine/io/control_points.h"
#include "engine/io/motion.h"
#include "engine/io/sequence.h"

namespace sinew::editor {

namespace {

namespace fs = std::filesystem;

using document::ExampleName;
using document::Layer;
using document::Project;
using Weights = std::vector<std::optional<double>>;

std::string name_of(const std::string& path) {
  const fs::path named(path);
  return named.has_filename() ? named.filename().string() : named.parent_path().filename().string();
}

bool is_folder(const std::string& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

bool is_shape(const std::string& path) {
  return fs::path(path).extension() != ".json" && !io::is_motion(path) && !io::is_control_points(path);
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  return a == b || fs::equivalent(a, b, error);
}

/// Whether a layer's answer is of the examples that the layer has now.
bool are_of(std::span<const ExampleName> examples, const Layer& layer) {
  return !examples.empty() && examples.back().entry + 1 == layer.examples.size() &&
         std::all_of(examples.begin(), examples.end(),
                     [&](const ExampleName& e) { return layer.examples[e.entry] == e.entry_path; });
}

void erase_weights(Weights& weights, std::span<const std::size_t> examples) {
  for (auto k = examples.rbegin(); k != examples.rend(); ++k)
    if (*k < weights.size()) weights.erase(weights.begin() + static_cast<std::ptrdiff_t>(*k));
}

}  // namespace

// Opening

bool Session::joins(const std::vector<std::string>& paths) const {
  if (!has_input() || paths.empty()) return false;
  if (paths.size() > 1 || is_folder(paths.front()) || !is_shape(paths.front())) return true;
  return layer() != nullptr && method() != nullptr && method()->parts.examples && paths.front() != input_path_;
}

/// Several shapes, or a folder of them, while nothing is open: the first becomes the shape, the others its poses.
void Session::open_first(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  const bool fine = refuse([&] {
    for (const std::string& path : paths)
      for (const std::string& file : io::pose_files(path)) files.push_back(file);
  });
  if (!fine) return;
  open_now({Opening::As::Shape, {files.front()}});
  files.erase(files.begin());
  if (!files.empty()) next_open_ = Opening{Opening::As::FirstPoses, files};
}

/// The layer that poses are for: the chosen one; a new one where there is none yet. Nothing where it takes none.
std::optional<Layer> Session::layer_to_pose() {
  const auto posed = std::find_if(methods_.begin(), methods_.end(), [](const Method& m) { return m.parts.examples; });
  if (!has_input() || posed == methods_.end()) return std::nullopt;
  if (input_->faces.empty()) {
    notify(Severity::Error, name_of(input_path_) + " has no faces: poses are examples of surfaces.");
    return std::nullopt;
  }
  Layer out = layer() != nullptr ? *layer() : standard_layer();
  if (layer() == nullptr) {
    out.method = posed->name;
    out.path.reset();
  } else if (method() == nullptr || !method()->parts.examples) {
    notify(Severity::Error, fmt::format("Poses are examples of a layer of the method {}: this layer's is {}.",
                                        posed->name, layer()->method));
    return std::nullopt;
  }
  return out;
}

/// Reads the poses, to see whether they correspond. One that was opened like any shape and does not is left to
/// take_declined().
void Session::open_poses(const Opening& opening) {
  const std::optional<Layer> layer = layer_to_pose();
  if (!layer) return;
  const bool may_be_shape =
      opening.as == Opening::As::Either && opening.paths.size() == 1 && !is_folder(opening.paths.front());
  const auto work = [this, opening, may_be_shape, input = input_, layer = *layer,
                     input_path = input_path_](const Tell& tell) mutable -> Background::Finish {
    std::vector<std::string> files;
    for (const std::string& path : opening.paths)
      for (const std::string& file : io::pose_files(path))
        if (!same_file(file, input_path) &&
            std::none_of(layer.examples.begin(), layer.examples.end(),
                         [&](const std::string& known) { return same_file(file, known); }))
          files.push_back(file);
    std::size_t poses = 0;
    layer.example_weights.clear();
    const auto look = [&] {
      for (std::size_t i = 0; i < files.size(); ++i) {
        if (!tell(static_cast<double>(i) / static_cast<double>(files.size()))) throw io::Cancelled{};
        layer.examples = {files[i]};
        poses += document::examples_of(layer, *input, {}).size();
      }
    };
    if (may_be_shape) {
      if (const std::string difference = sentence_of_failure(look); !difference.empty()) {
        // A file that can't be read is no other shape either.
        const std::string& path = opening.paths.front();
        const std::string broken = sentence_of_failure([&] {
          const Sequence read = io::open_sequence(path);
          read.load(read.frames.front());
        });
        return [this, difference, broken, path] {
          notify(broken.empty() ? Severity::Info : Severity::Warning, broken.empty() ? difference : broken);
          if (broken.empty()) declined_ = path;
        };
      }
    } else {
      look();
    }
    return [this, input, files, poses, first = opening.as == Opening::As::FirstPoses] {
      if (input == input_) take_poses(files, poses, first);
    };
  };
  background_->start("Reading poses", true, work);
}

void Session::take_poses(const std::vector<std::string>& files, std::size_t poses, bool first) {
  if (files.empty()) {
    notify(Severity::Hint, "These poses are examples already.");
    return;
  }
  std::optional<Layer> layer = layer_to_pose();
  if (!layer) return;
  cancel_drag();
  layer->examples.insert(layer->examples.end(), files.begin(), files.end());
  Project project = history_.present();
  if (project.layers.empty()) project.layers.emplace_back();
  project.layers[layer_] = std::move(*layer);
  forget_starts(project, layer_);
  if (!refuse([&] { document::check_layers(project.layers, methods_); })) return;
  apply(std::move(project), "Add poses");
  const std::string what = poses == 1 ? "1 pose" : std::to_string(poses) + " poses";
  notify(Severity::Info, first ? fmt::format("{} is the shape; {} beside it {} its examples.", name_of(input_path_),
                                             what, poses == 1 ? "is one of" : "are")
                               : fmt::format("{} added to the examples of the layer.", what));
}

std::optional<std::string> Session::take_declined() {
  return std::exchange(declined_, std::nullopt);
}

// Weights

/// How much of each example the chosen layer asks for at the frame shown, with the drag that runs.
Weights Session::asked_weights() const {
  const Layer& now = drag_ ? drag_->now.layers[layer_] : *layer();
  const std::vector<document::Key> keys = document::keys_of(now, frames().front());
  const document::KeySpan span = document::span_of(keys, frame_);
  return document::weights_between(keys[span.first].example_weights, keys[span.second].example_weights, span.u);
}

std::vector<ExampleView> Session::examples() const {
  std::vector<ExampleView> out;
  if (layer() == nullptr || !has_input()) return out;
  const document::LayerResult* shown = shown_layer();
  const Weights asked = asked_weights();
  if (shown == nullptr || !are_of(shown->examples, *layer())) {
    for (const std::string& path : layer()->examples) out.push_back({fs::path(path).stem().string(), path, {}, {}});
    return out;
  }
  for (std::size_t k = 0; k < shown->examples.size(); ++k) {
    ExampleView view{shown->examples[k].name, shown->examples[k].path, {}, {}};
    if (k < asked.size()) view.pinned = asked[k];
    const std::vector<double>& solved = shown->report.example_weights;
    view.weight = view.pinned.value_or(k < solved.size() ? solved[k] : 0);
    out.push_back(std::move(view));
  }
  return out;
}

/// The chosen layer with these weights, at the frame shown where it has keys or moves.
Layer Session::with_weights(Weights weights) const {
  if (!keyed()) {
    Layer out = *layer();
    while (!weights.empty() && !weights.back()) weights.pop_back();
    out.example_weights = std::move(weights);
    return out;
  }
  Layer out = keyed_here(true);
  for (document::Key& key : out.keys)
    if (key.frame == frame_) key.example_weights = weights;
  return out;
}

void Session::set_weights(Weights weights, const std::string& label) {
  cancel_drag();
  Project project = history_.present();
  project.layers[layer_] = with_weights(std::move(weights));
  forget_starts(project, layer_);
  apply(std::move(project), label);
}

/// As they are asked for now, one an example; nothing while they are not known.
std::optional<Weights> Session::known_weights() const {
  Weights out;
  for (const ExampleView& example : examples()) {
    if (!example.weight) return std::nullopt;
    out.push_back(example.pinned);
  }
  return out.empty() ? std::nullopt : std::optional(out);
}

void Session::pin_example(std::size_t example, std::optional<double> weight) {
  std::optional<Weights> weights = known_weights();
  if (!weights || example >= weights->size()) return;
  (*weights)[example] = weight;
  set_weights(std::move(*weights), (weight ? "Pin " : "Free ") + examples()[example].name);
}

void Session::pin_examples() {
  std::optional<Weights> weights = known_weights();
  if (!weights) return;
  const std::vector<ExampleView> views = examples();
  for (std::size_t k = 0; k < views.size(); ++k) (*weights)[k] = views[k].weight;
  set_weights(std::move(*weights), "Pin all weights");
}

void Session::free_examples() {
  if (std::optional<Weights> weights = known_weights())
    set_weights(Weights(weights->size(), std::nullopt), "Free all weights");
}

void Session::rest_examples() {
  if (std::optional<Weights> weights = known_weights()) set_weights(Weights(weights->size(), 0.0), "Weights at rest");
}

bool Session::begin_weight(std::size_t example) {
  end_drag();
  std::optional<Weights> weights = known_weights();
  if (!weights || example >= weights->size() || !layer()->on) return false;
  const std::vector<ExampleView> views = examples();
  Drag drag = drag_from_here();
  (*weights)[example] = views[example].weight;
  drag.now.layers[layer_] = with_weights(std::move(*weights));
  drag.example = example;
  drag.label = "Weight of " + views[example].name;
  drag_ = std::move(drag);
  return true;
}

void Session::weight_to(double weight) {
  if (!drag_ || !drag_->example) return;
  Layer& now = drag_->now.layers[layer_];
  const auto key = std::find_if(now.keys.begin(), now.keys.end(),
                                [&](const document::Key& at) { return keyed() && at.frame == frame_; });
  Weights& weights = key != now.keys.end() ? key->example_weights : now.example_weights;
  if (weights.size() > *drag_->example && weights[*drag_->example] == weight && drag_->moved) return;
  weights.resize(std::max(weights.size(), *drag_->example + 1));
  weights[*drag_->example] = weight;
  drag_->moved = true;
  ask(SolveOptions::Quality::Interactive, drag_->now);
}

/// Of a folder that is one entry the other files stay; of a file with several poses all go.
void Session::remove_example(std::size_t example) {
  cancel_drag();
  const std::vector<ExampleView> views = examples();
  if (example >= views.size()) return;
  Project project = history_.present();
  Layer& layer = project.layers[layer_];
  std::vector<std::size_t> gone;
  std::size_t entry = example;
  std::vector<std::string> stay;
  if (views[example].weight) {
    const std::vector<ExampleName>& names = shown_layer()->examples;
    entry = names[example].entry;
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (names[k].entry != entry) continue;
      if (names[k].path == names[example].path)
        gone.push_back(k);
      else if (stay.empty() || stay.back() != names[k].path)
        stay.push_back(names[k].path);
    }
  } else {
    gone = {example};
  }
  const auto place = layer.examples.erase(layer.examples.begin() + static_cast<std::ptrdiff_t>(entry));
  layer.examples.insert(place, stay.begin(), stay.end());
  erase_weights(layer.example_weights, gone);
  for (document::Key& key : layer.keys) erase_weights(key.example_weights, gone);
  forget_starts(project, layer_);
  apply(std::move(project), "Remove pose " + views[example].name);
}

}  // namespace sinew::editor
