#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "apps/editor/session.h"
#include "engine/document/settings.h"
#include "engine/geometry/error.h"
#include "engine/geometry/nearest.h"
#include "engine/io/control_points.h"
#include "engine/io/io.h"

namespace sinew::editor {

namespace {

/// Control points farther from the shape than this part of its diagonal are told.
constexpr double far_off = 0.02;

std::string name_of(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

}  // namespace

/// A control point on its point of the shape.
struct Session::Control {
  std::string name;
  Index point = 0;
  Vec3 to = Vec3::Zero();  ///< relative to the origin
  double away = 0;         ///< of the point from where the control point was measured
};

/// The point that each is on. A place that is beside the nearest point moves it by what it is to move itself.
static void take_places(const Shape& shape, const PointSet& finite, std::span<const io::ControlPoint> read,
                        auto& controls) {
  const std::vector<Index> points = finite.indices();
  std::vector<Vec3> positions, places;
  for (const Index i : points) positions.push_back(shape.positions[i]);
  for (const io::ControlPoint& control : read) places.push_back(control.at - shape.origin);
  std::vector<std::uint32_t> nearest(read.size());
  std::vector<double> distance(read.size());
  NearestTree(positions).nearest(places, 1, nearest, distance);
  for (std::size_t k = 0; k < read.size(); ++k) {
    if (read[k].point) continue;
    controls[k].point = points[nearest[k]];
    controls[k].away = distance[k];
    controls[k].to += positions[nearest[k]] - places[k];
  }
}

void Session::add_control_points(const std::string& path) {
  open_next({Opening::As::ControlPoints, {path}});
}

void Session::open_control_points(const std::string& path) {
  if (!has_input()) {
    notify(Severity::Error, name_of(path) + " has control points: open the shape that they are on before it.");
    return;
  }
  const auto work = [this, path, input = input_, finite = finite_](const Tell& tell) -> Background::Finish {
    const std::vector<io::ControlPoint> read = io::read_control_points(path);
    if (finite.empty()) throw file_error(path, "a shape with points", "none that is finite");
    auto controls = std::make_shared<std::vector<Control>>();
    bool places = false;
    for (std::size_t k = 0; k < read.size(); ++k) {
      const std::optional<Index> point = read[k].point;
      if (point && (*point >= input->size() || !finite[*point]))
        throw file_error(path, fmt::format("numbers of finite points below {}", input->size()), std::to_string(*point));
      std::string name = read[k].name;
      if (name.empty()) name = point ? fmt::format("Point {}", *point) : std::to_string(k + 1);
      controls->push_back({name, point.value_or(0), read[k].to - input->origin, 0});
      places |= !point;
    }
    if (places) take_places(*input, finite, read, *controls);
    if (!tell(1)) throw io::Cancelled{};
    return [this, path, input, controls] {
      if (input == input_) take_control_points(path, std::move(*controls));
    };
  };
  background_->start("Reading " + name_of(path), true, work);
}

/// One handle a point: of several on one point the nearest is taken.
void Session::take_control_points(const std::string& path, std::vector<Control> controls) {
  cancel_drag();
  const std::size_t read = controls.size();
  const auto far = static_cast<std::size_t>(std::count_if(
      controls.begin(), controls.end(), [&](const Control& c) { return c.away > far_off * bounds_.diagonal(); }));
  std::vector<std::size_t> best(input_->size(), controls.size());
  for (std::size_t k = 0; k < controls.size(); ++k)
    if (std::size_t& taken = best[controls[k].point];
        taken == controls.size() || controls[k].away < controls[taken].away)
      taken = k;
  document::Project project = history_.present();
  if (project.layers.empty()) project.layers.push_back(standard_layer());
  const std::optional<int> frame = stream_ ? std::optional(frame_) : std::nullopt;
  std::vector<document::HandleEdit> handles;
  PointSet points(input_->size());
  for (std::size_t k = 0; k < controls.size(); ++k) {
    const Control& control = controls[k];
    if (best[control.point] != k) continue;
    points.add(control.point);
    document::HandleEdit& handle = handles.emplace_back();
    handle.name = control.name;
    handle.points = {document::SelectIndices{document::Shared<Index>({control.point})}, {}, frame};
    // What moves is carried along with its frames, so that a target in one of them is a way from there.
    if (moves())
      handle.motion.move = Vec3(control.to - bent(*input_, shown_, layer_, std::span(&control.point, 1)).front());
    else
      handle.motion.to = document::Shared<Vec3>({control.to + input_->origin});
  }
  document::Layer& layer = project.layers[layer_];
  if (this->layer() != nullptr && !moves()) layer = with_pivots(layer, handle_rest_centres(), input_->origin);
  layer = with_handles(layer, this->layer() != nullptr ? layer_points() : LayerPoints{}, points, handles, frame);
  forget_starts(project, layer_);
  if (!refuse([&] { document::check_layers(project.layers, methods_); })) return;
  if (far > 0)
    notify(Severity::Warning, fmt::format("{}: {} of {} control points are farther from the shape than {:.0f} % of its "
                                          "size. Are they in its unit and axes?",
                                          name_of(path), far, read, 100 * far_off));
  if (handles.size() < read)
    notify(Severity::Warning, fmt::format("{}: {} of {} control points are left out, as nearer ones are on the same "
                                          "points of the shape.",
                                          name_of(path), read - handles.size(), read));
  apply(std::move(project), fmt::format("{} control point{}", handles.size(), handles.size() == 1 ? "" : "s"));
  handle_.reset();
  changed_.control_points = true;
}

const std::vector<Residual>& Session::residuals() {
  if (!residuals_) {
    residuals_.emplace();
    if (has_input() && layer() != nullptr) {
      const document::Layer& now = drag_ ? drag_->now.layers[layer_] : *layer();
      residuals_ = residuals_of(*input_, shown_, now, layer_);
    }
  }
  return *residuals_;
}

}  // namespace sinew::editor
