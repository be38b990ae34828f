#include <fmt/format.h>
#include <imgui.h>

#include <array>
#include <filesystem>

#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

namespace {

using document::MarkersEdit;

/// A number of the motion, which is changed once it is let go or typed. True then.
bool field(Ui& ui, const char* name, const char* help, const widget::Number& described, double& value) {
  widget::label(name, help);
  ImGui::PushID(name);
  const std::string id = fmt::format("motion/{}", name);
  double shown = ui.edited_name == id ? ui.edited_value : value;
  const bool done = widget::number("##value", shown, described);
  if (ImGui::IsItemActive()) {
    ui.edited_name = id;
    ui.edited_value = shown;
  } else if (ui.edited_name == id) {
    ui.edited_name.clear();
  }
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) widget::tooltip(help);
  ImGui::PopID();
  if (done) value = shown;
  return done;
}

/// The markers grow about what they are turned about, which stays where it is.
bool show_scale(Ui& ui, MarkersEdit& edit) {
  const document::Markers* markers = ui.context.session.markers();
  double scale = edit.scale.value_or(markers != nullptr ? markers->scale() : 1);
  const double before = scale;
  if (!field(ui, "Scale", "How large the shape is for one unit of the motion", {1e-9, 1e9, false, false, ""}, scale))
    return false;
  edit.scale = scale;
  if (edit.rotate && edit.rotate->about && edit.move) *edit.move += (before - scale) * *edit.rotate->about;
  return true;
}

bool show_turn(Ui& ui, MarkersEdit& edit) {
  document::Rotation turn = edit.rotate.value_or(document::Rotation{Vec3::UnitX(), 0, {}});
  std::vector<std::string> axes{"X", "Y", "Z"};
  std::size_t axis = 0;
  while (axis < 3 && turn.axis.cwiseAbs().stableNormalized() != Vec3::Unit(static_cast<Eigen::Index>(axis))) ++axis;
  if (axis == 3) axes.emplace_back("as in the file");
  if (axis < 3 && turn.axis[static_cast<Eigen::Index>(axis)] < 0) turn.degrees = -turn.degrees;
  if (axis < 3) turn.axis = Vec3::Unit(static_cast<Eigen::Index>(axis));
  widget::label("Turn about", "The axis that the motion is turned about, to lie along the shape");
  bool changed = widget::choice("##turn axis", axis, axes);
  if (changed && axis < 3) turn.axis = Vec3::Unit(static_cast<Eigen::Index>(axis));
  changed |= field(ui, "Turn by", "How far the motion is turned", {-360, 360, false, false, "°"}, turn.degrees);
  if (changed) edit.rotate = turn;
  return changed;
}

bool show_move(Ui& ui, MarkersEdit& edit) {
  Vec3 move = edit.move.value_or(Vec3(0, 0, 0));
  const std::array<const char*, 3> names{"Move X", "Move Y", "Move Z"};
  bool changed = false;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    changed |= field(ui, names[static_cast<std::size_t>(axis)], "How far the motion is moved, in units of the shape",
                     {-1e9, 1e9, false, false, ""}, move[axis]);
  if (changed) edit.move = move;
  return changed;
}

void value(const char* name, const char* help, const std::string& text) {
  widget::label(name, help);
  widget::text_cut(text, ImGui::GetContentRegionAvail().x, theme().text);
}

/// Three digits; what is only rounding is 0.
std::string distance(const Session& session, double length) {
  return fmt::format("{:.3g}", length > 1e-9 * session.rest_bounds().diagonal() ? length : 0);
}

}  // namespace

void show_motion(Ui& ui) {
  Session& session = ui.context.session;
  const document::Layer* layer = session.layer();
  if (layer == nullptr || !layer->markers) return;
  MarkersEdit edit = *layer->markers;
  value("Motion", "The file of the motion that drives this layer",
        std::filesystem::path(edit.path).filename().string());
  bool changed = show_scale(ui, edit);
  if (edit.matches.empty()) {
    changed |= show_turn(ui, edit);
    changed |= show_move(ui, edit);
  } else {
    const document::Markers* markers = session.markers();
    value("Matches", "Markers whose places on the shape the edit tells, and how far the motion lies from them",
          markers == nullptr ? std::to_string(edit.matches.size())
                             : fmt::format("{}, {} away", edit.matches.size(), distance(session, markers->fit_rms())));
  }
  double bridge = edit.bridge;
  if (field(ui, "Bridge", "In longer gaps a marker is let go", {0, 1e6, true, false, "frames"}, bridge)) {
    edit.bridge = static_cast<int>(bridge);
    changed = true;
  }
  if (changed) session.set_markers(edit);
}

}  // namespace sinew::editor
