#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "apps/editor/icons.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

namespace {

constexpr float panel_width = 272;
constexpr std::size_t most_rows = 10;

/// The handle in the middle of the picture, from the same direction.
void frame_handle(Ui& ui, std::size_t handle) {
  Session& session = ui.context.session;
  session.choose_handle(handle);
  View& view = ui.context.view;
  const Vec3 target = session.handles()[handle].target, reach = Vec3::Constant(0.06 * session.rest_bounds().diagonal());
  Bounds bounds;
  bounds.add(target - reach);
  bounds.add(target + reach);
  glide_to(view, framed(view.camera, bounds, view.size.x() / view.size.y(), 0.5));
}

void show_row(Ui& ui, const Residual& residual, bool worst) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = px(measure::row);
  ImGui::PushID(static_cast<int>(residual.handle));
  if (ImGui::InvisibleButton("row", {width, height})) frame_handle(ui, residual.handle);
  ImDrawList* list = ImGui::GetWindowDrawList();
  const bool chosen = ui.context.session.chosen_handle() == residual.handle;
  if (chosen || ImGui::IsItemHovered())
    list->AddRectFilled({at.x - px(6), at.y}, {at.x + width + px(2), at.y + height},
                        packed(chosen ? theme().chosen : theme().hover), px(4));
  if (ImGui::IsItemHovered())
    widget::tooltip(fmt::format("{}: {} from its target{}", residual.name, fmt::format("{:.6g}", residual.distance),
                                residual.points > 1 ? fmt::format(" (rms of {} points)", residual.points) : ""));
  const std::string distance = fmt::format("{:.3g}", residual.distance);
  const ImVec2 size = ImGui::CalcTextSize(distance.c_str());
  const float y = at.y + 0.5f * (height - size.y);
  list->AddCircleFilled({at.x + px(5), at.y + 0.5f * height}, px(4), packed(worst ? theme().warning : theme().handle),
                        20);
  widget::text_at(list, ImGui::GetFont(), {at.x + px(20), y}, worst ? theme().warning : theme().text,
                  widget::cut(residual.name, width - size.x - px(32)));
  widget::text_at(list, ImGui::GetFont(), {at.x + width - size.x, y}, worst ? theme().warning : theme().quiet,
                  distance);
  ImGui::PopID();
}

void show_rows(Ui& ui, const std::vector<Residual>& residuals, std::size_t rows) {
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(6), 0));
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() - px(6));
  ImGui::BeginChild("rows", {0, px(measure::row) * static_cast<float>(rows)}, false,
                    ImGuiWindowFlags_AlwaysUseWindowPadding | ImGuiWindowFlags_NoNav);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(residuals.size()), px(measure::row));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      show_row(ui, residuals[static_cast<std::size_t>(i)], i == 0 && residuals.size() > 1);
  ImGui::EndChild();
  ImGui::PopStyleVar(2);
}

}  // namespace

void show_residuals(Ui& ui) {
  Session& session = ui.context.session;
  if (!ui.context.view.show_residuals || !session.has_input()) return;
  const float left = tools_right(ui), right = std::min(left + px(panel_width), ui.layout.column - px(measure::edge));
  if (ui.context.view.choosing && right > choosing_panel(ui).x) return;  // there is no room for both
  const std::vector<Residual> residuals = session.residuals();
  // Beside the axes, or below them.
  const float top = ui.layout.top + (right > ui.layout.column - px(96) ? px(96) : px(measure::edge + 40));
  const float around = px(2 * measure::row + 28 + 24);
  const auto room =
      static_cast<std::size_t>(std::max(1.0f, (ui.layout.bottom - px(8) - top - around) / px(measure::row)));
  const std::size_t rows = std::clamp<std::size_t>(residuals.size(), 1, std::min(room, most_rows));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(6));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(measure::pad), px(8)));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(8), px(4)));
  const float height = px(measure::row) * static_cast<float>(rows) + around;
  widget::begin_panel("residuals", {left, top}, {right - left, height});
  const ImVec2 start = ImGui::GetCursorScreenPos();
  widget::heading("RESIDUALS, IN THE SHAPE'S UNIT", true);
  const ImVec2 after = ImGui::GetCursorScreenPos();
  ImGui::SetCursorScreenPos({start.x + ImGui::GetContentRegionAvail().x - px(16), start.y + px(4)});
  if (widget::icon_button(icon::close, "close", false, px(20), theme().quiet, "Close"))
    ui.context.view.show_residuals = false;
  ImGui::SetCursorScreenPos(after);
  if (residuals.empty()) {
    ImGui::TextDisabled("%s", session.solving() ? "Solving..." : "This layer has no handles of points.");
  } else {
    show_rows(ui, residuals, rows);
    ImGui::Dummy({0, 0});
    ImGui::TextDisabled("%s",
                        fmt::format("rms of {} handle{}", residuals.size(), residuals.size() == 1 ? "" : "s").c_str());
    widget::value_right(fmt::format("{:.3g}", rms_of(residuals)), theme().text);
    if (widget::button("Copy as CSV", false)) ImGui::SetClipboardText(csv_of(residuals).c_str());
  }
  ImGui::End();
  ImGui::PopStyleVar(3);
}

}  // namespace sinew::editor
