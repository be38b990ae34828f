#include <fmt/format.h>
#include <imgui.h>

#include <cmath>

#include "apps/editor/gui.h"
#include "apps/editor/icons.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

namespace {

constexpr double least = -0.5, most = 1.5;  ///< weights that a bar shows

/// A command as a small button, `width` pixels wide.
void small_button(Ui& ui, const char* command, const char* text, float width) {
  const Command* found = find_command(command);
  if (found == nullptr) return;
  ImGui::PushStyleColor(ImGuiCol_Button, theme().field);
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, theme().chosen);
  ImGui::PushStyleColor(ImGuiCol_ButtonActive, theme().hover);
  ImGui::BeginDisabled(!found->enabled(ui.context));
  const bool pressed = ImGui::Button(text, {width, 0});
  ImGui::EndDisabled();
  ImGui::PopStyleColor(3);
  if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) widget::tooltip(found->help);
  if (pressed) run_command(*found, ui.context);
}

/// Name, weight, pin and cross.
void show_example(Session& session, std::size_t k, const ExampleView& example) {
  const float side = px(20), gap = px(4);
  const float icons = 2 * (side + gap);
  ImGui::PushID(static_cast<int>(k));
  widget::label(example.name, fmt::format("{}\nDrag the bar; Ctrl and a click on it types any number.", example.path));
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - icons);
  ImGui::BeginDisabled(!example.weight);
  double weight = example.weight.value_or(0);
  const widget::BarUse use = widget::bar("##weight", weight, least, most, example.pinned.has_value());
  if (use.begun) session.begin_weight(k);
  if (use.changed) session.weight_to(weight);
  if (use.cancelled) session.cancel_drag();
  if (use.ended) session.end_drag();
  ImGui::SameLine(0, gap);
  const bool pinned = example.pinned.has_value();
  if (widget::icon_button(icon::pin, "pin", pinned, side, pinned ? theme().accent : theme().faint,
                          pinned ? "Held by you: click to let the handles find it" : "Hold it where it is"))
    session.pin_example(k, pinned ? std::nullopt : example.weight);
  ImGui::EndDisabled();
  ImGui::SameLine(0, gap);
  if (widget::icon_button(icon::close, "remove", false, side, theme().faint, "Remove this pose from the examples"))
    session.remove_example(k);
  ImGui::PopID();
}

}  // namespace

void show_examples(Ui& ui) {
  Session& session = ui.context.session;
  if (session.layer() == nullptr || session.method() == nullptr || !session.method()->parts.examples) return;
  widget::heading("EXAMPLES");
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(8), std::floor(0.5f * (px(20) - ImGui::GetFontSize()))));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(8), px(4)));
  const std::vector<ExampleView> examples = session.examples();
  for (std::size_t k = 0; k < examples.size(); ++k) show_example(session, k, examples[k]);
  const float gap = px(4), whole = ImGui::GetContentRegionAvail().x;
  if (!examples.empty()) {
    const float third = std::floor((whole - 2 * gap) / 3);
    small_button(ui, "layer.pin_weights", "Pin all", third);
    ImGui::SameLine(0, gap);
    small_button(ui, "layer.free_weights", "Free all", third);
    ImGui::SameLine(0, gap);
    small_button(ui, "layer.rest_weights", "Rest", whole - 2 * (third + gap));
  }
  small_button(ui, "layer.add_poses", "Add poses...", whole);
  ImGui::PopStyleVar(2);
}

}  // namespace sinew::editor
