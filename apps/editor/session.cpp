#include "apps/editor/session.h"

#include <algorithm>
#include <filesystem>

#include "engine/document/settings.h"

namespace sinew::editor {

namespace {

/// Layers that may move a point.
bool any_on(const document::Project& project) {
  return std::any_of(project.layers.begin(), project.layers.end(),
                     [](const document::Layer& layer) { return layer.on; });
}

}  // namespace

Session::Session(std::span<const Method> methods, std::function<void()> wake)
    : methods_(repeatable(methods)),
      file_methods_(methods.begin(), methods.end()),
      wake_(std::move(wake)),
      background_(std::make_unique<Background>(wake_)),
      measuring_(std::make_unique<Background>(wake_)),
      hashing_(std::make_unique<Background>(wake_)),
      solver_(std::make_unique<document::SolverThread>(methods_, wake_)) {}

Session::~Session() {
  finish_waiting();
}

Changed Session::poll() {
  take_background();
  while (std::optional<document::SolveAnswer> answer = solver_->answer()) take_answer(std::move(*answer));
  if (const bool now = preparing(); now != preparing_since_.has_value()) {
    preparing_since_ = now ? std::optional(seconds_now()) : std::nullopt;
    changed_.project = true;
  }
  advance();
  start_waiting();
  measure();
  watch_journal();
  return std::exchange(changed_, {});
}

const document::Layer* Session::layer() const {
  return layer_ < project().layers.size() ? &project().layers[layer_] : nullptr;
}

const Method* Session::method() const {
  const std::string name = layer() != nullptr ? layer()->method : standard_layer().method;
  const auto found = std::find_if(methods_.begin(), methods_.end(), [&](const Method& m) { return m.name == name; });
  return found == methods_.end() ? nullptr : &*found;
}

bool Session::solving() const {
  return has_input() && !settled();
}

bool Session::settled() const {
  return !drag_ && answered_ && !settling_ && !playing_;
}

/// Asks for an answer to `project`. Where it has no layer yet, the one that a first mark will make is prepared.
void Session::ask(SolveOptions::Quality quality, const document::Project& project) {
  if (!has_input()) return;
  document::SolveRequest request;
  request.ticket = ++ticket_;
  request.input = sequence_;
  request.frame = wanted_frame_;
  request.layers = project.layers.empty() ? std::vector{standard_layer()} : project.layers;
  request.quality = quality;
  if (quality == SolveOptions::Quality::Final) {
    final_ticket_ = ticket_;
    answered_ = false;
  }
  solver_->ask(std::move(request));
}

void Session::take_answer(document::SolveAnswer answer) {
  if (answer.input != sequence_ || !has_input()) return;
  if (!answer.error.empty()) {
    if (answer.ticket != ticket_) return;
    // Said once, however often a drag asks; hints() keeps it.
    if (answer.error != failure_) notify(Severity::Error, answer.error);
    failure_ = answer.error;
    wanted_frame_ = frame_;  // a frame that can't be read is not waited for
    playing_ = false;
    answered_ = true;
    settling_.reset();
    return;
  }
  if (answer.ticket == ticket_ && answer.finished) failure_.clear();
  if (moves() && !drag_) {
    if (answer.ticket == ticket_ && answer.finished) show_frame(std::move(answer));
    return;
  }
  if (drag_) {
    if (answer.ticket < drag_->first_ticket || answer.frame != frame_) return;
    shown_ticket_ = answer.ticket;
    show_answer(std::move(answer.layers));
  } else if (answer.ticket == final_ticket_ && answer.final_quality) {
    // Steps of a final solve are not shown: it begins at rest, and the shape would jump.
    answered_ = true;
    settle(std::move(answer.layers));
  }
}

void Session::show_answer(std::vector<document::LayerResult> layers) {
  const bool same_weights = std::equal(layers.begin(), layers.end(), shown_.begin(), shown_.end(),
                                       [](const auto& a, const auto& b) { return a.weights == b.weights; });
  const bool same_poses = same_weights && std::equal(layers.begin(), layers.end(), shown_.begin(), shown_.end(),
                                                     [](const auto& a, const auto& b) { return a.pose == b.pose; });
  shown_ = std::move(layers);
  residuals_.reset();
  changed_.weights |= !same_weights;
  if (!same_poses) {
    changed_.pose = true;
    bent_ready_ = false;
    ++bent_version_;
    if (layer_ > 0) handle_centres_.reset();
  }
  figures_ = figures_of(*input_, shown_, layer_, bounds_.diagonal(), sample_stride(input_->size()));
  measured_version_ = 0;  // an answer with the pose that was measured has a report of its own
  if (!any_on(project()) && !drag_) figures_ = {};
}

/// The figures of a settled answer, from all points, while nobody waits for them; the bent positions come with them.
void Session::measure() {
  if (const std::optional<Background::Outcome> outcome = measuring_->take(); outcome && outcome->finish)
    outcome->finish();
  if (!has_input() || !settled() || measuring_->busy() || measured_version_ == bent_version_) return;
  measured_version_ = bent_version_;
  measuring_->start("Measuring", false,
                    [this, input = input_, layers = shown_, layer = layer_, diagonal = bounds_.diagonal(),
                     version = bent_version_](const Tell&) -> Background::Finish {
                      auto positions = std::make_shared<std::vector<Vec3>>(input->size());
                      bend_all(*input, layers, *positions);
                      const StatusFigures figures = figures_of(*input, layers, layer, diagonal, 1);
                      return [this, positions, figures, version, layer] {
                        if (version != bent_version_) return;
                        bent_ = std::move(*positions);
                        bent_ready_ = true;
                        if (layer == layer_) figures_ = figures;
                      };
                    });
}

std::span<const Vec3> Session::bent_positions() {
  if (!has_input()) return {};
  if (!bent_ready_) {
    bent_.resize(input_->size());
    bend_all(*input_, shown_, bent_);
    bent_ready_ = true;
  }
  return bent_;
}

const std::vector<std::uint8_t>& Session::point_marks() {
  if (!marks_ready_) {
    marks_ = mark_bits(layer_points(), selection_, hidden_);
    marks_ready_ = true;
  }
  return marks_;
}

std::vector<float> Session::point_stiffness() {
  if (layer() == nullptr || !has_input()) return {};
  return stiffness_factors(*layer(), layer_points(), input_->size());
}

Bounds Session::bent_bounds() {
  if (hidden_.empty()) return bounds_of(bent_positions());
  Bounds out;
  selectable().each([&, positions = bent_positions()](std::size_t i) { out.add(positions[i]); });
  return out;
}

Bounds Session::selection_bounds() {
  Bounds out;
  const std::span<const Vec3> positions = bent_positions();
  selection_.each([&](std::size_t i) { out.add(positions[i]); });
  if (out.empty() && handle_ && *handle_ < layer_points().handles.size())
    for (const Index i : layer_points().handles[*handle_]) out.add(positions[i]);
  return out;
}

std::vector<Notice> Session::hints() const {
  std::vector<Notice> out;
  if (!has_input()) return out;
  if (!failure_.empty()) out.push_back({Severity::Error, failure_});
  if (const document::Layer* layer = this->layer(); layer != nullptr && layer->on) {
    if (layer->handles.size() == 1 && layer->fixed.empty())
      out.push_back({Severity::Hint, "A handle needs something fixed: select points that are to stay, and fix them."});
    if (layer->handles.empty() && !layer->fixed.empty())
      out.push_back({Severity::Hint, "Now select the points to pull, and make them a handle."});
  }
  if (const std::vector<ExampleView> poses = examples(); !poses.empty() && layer()->on && layer()->handles.empty()) {
    const bool free =
        std::none_of(poses.begin(), poses.end(), [](const auto& pose) { return pose.pinned.has_value(); });
    if (free) out.push_back({Severity::Hint, "Drag the bar of an example to blend, or mark handles and drag them."});
  }
  if (!figures_.message.empty()) out.push_back({Severity::Warning, figures_.message});
  return out;
}

std::vector<Notice> Session::take_notices() {
  return std::exchange(notices_, {});
}

void Session::notify(Severity severity, std::string text) {
  notices_.push_back({severity, std::move(text)});
}

/// Points of the chosen layer's marks; of no layer none.
const LayerPoints& Session::layer_points() {
  if (!layer_points_) {
    LayerPoints points;
    if (const document::Layer* chosen = layer(); chosen != nullptr && selector_ != nullptr)
      if (!refuse([&] { points = points_of(*chosen, *selector_, stream_ ? std::optional(frame_) : std::nullopt); }))
        points = {};
    points.fixed.resize(layer() == nullptr ? 0 : layer()->fixed.size());
    points.handles.resize(layer() == nullptr ? 0 : layer()->handles.size());
    points.rigid.resize(layer() == nullptr ? 0 : layer()->rigid.size());
    points.stiff.resize(layer() == nullptr ? 0 : layer()->stiffness.size());
    layer_points_ = std::move(points);
  }
  return *layer_points_;
}

bool Session::refuse(const std::function<void()>& check) {
  const std::string failure = sentence_of_failure(check);
  if (!failure.empty()) notify(Severity::Error, failure);
  return failure.empty();
}

}  // namespace sinew::editor
