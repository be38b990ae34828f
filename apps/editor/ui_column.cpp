#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/editor/gui.h"
#include "apps/editor/icons.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"
#include "engine/document/settings.h"

namespace sinew::editor {

namespace {

std::string name_of(const document::Layer& layer, std::size_t index) {
  return layer.name.empty() ? fmt::format("Layer {}", index + 1) : layer.name;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// "example_weights" of a setting as "Example weights".
std::string title_of(const std::string& name) {
  std::string title = name;
  std::replace(title.begin(), title.end(), '_', ' ');
  if (!title.empty()) title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  return title;
}

/// A row of the whole width; true when it was clicked. Ends with the cursor at its start, to draw into.
bool row(const char* id, bool chosen, float indent) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = px(measure::row);
  const bool pressed = ImGui::InvisibleButton(id, {width, height}, ImGuiButtonFlags_MouseButtonLeft);
  ImGui::SetItemAllowOverlap();
  if (chosen || ImGui::IsItemHovered())
    ImGui::GetWindowDrawList()->AddRectFilled({at.x - px(6), at.y}, {at.x + width + px(6), at.y + height},
                                              packed(chosen ? theme().chosen : theme().hover), px(4));
  ImGui::SetCursorScreenPos({at.x + indent, at.y + std::round(0.5f * (height - ImGui::GetFontSize()))});
  return pressed;
}

void end_row(const ImVec2& start) {
  ImGui::SetCursorScreenPos({start.x, start.y + px(measure::row)});
}

void show_input(Ui& ui) {
  const Session& session = ui.context.session;
  const ImVec2 start = ImGui::GetCursorScreenPos();
  const std::size_t parts = session.input()->parts.size();
  std::string size = grouped(session.input()->size());
  if (parts > 1) size = fmt::format("{} scans · {}", parts, size);
  const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(size.c_str()).x - px(32);
  row("input", false, 0);
  if (ImGui::IsItemHovered())
    widget::tooltip(fmt::format("{}\n{}, {} points, {} faces", session.input_path(), representation(*session.input()),
                                grouped(session.input()->size()), grouped(session.input()->faces.size())));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  widget::text_at(ImGui::GetWindowDrawList(), ImGui::GetFont(), at, theme().faint, icon::cube);
  ImGui::SetCursorScreenPos({at.x + px(22), at.y});
  widget::text_cut(std::filesystem::path(session.input_path()).filename().string(), room, theme().text);
  widget::value_right(size, theme().faint);
  end_row(start);
}

void show_layer(Ui& ui, std::size_t index) {
  Session& session = ui.context.session;
  const document::Layer& layer = session.project().layers[index];
  ImGui::PushID(static_cast<int>(index));
  const ImVec2 start = ImGui::GetCursorScreenPos();
  std::string about = layer.method;
  for (const document::LayerResult& result : session.shown())
    if (result.layer == index && result.structure) about += " · " + grouped(result.structure->vertices.size());
  const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(about.c_str()).x - px(48);
  if (row("layer", session.chosen_layer() == index, px(18))) session.choose_layer(index);
  const bool renames = ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0);
  if (ImGui::BeginPopupContextItem("layer menu")) {
    if (ImGui::MenuItem("Rename")) {
      ui.renaming = index;
      ui.new_name = name_of(layer, index);
    }
    if (ImGui::MenuItem(layer.on ? "Turn off" : "Turn on")) session.toggle_layer(index);
    if (ImGui::MenuItem("Remove")) session.remove_layer(index);
    ImGui::EndPopup();
    if (index >= session.project().layers.size()) {
      ImGui::PopID();
      return;
    }
  }
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool on = layer.on;
  ImGui::SetCursorScreenPos({at.x - px(4), start.y});
  if (ImGui::InvisibleButton("eye", {px(22), px(measure::row)})) session.toggle_layer(index);
  if (ImGui::IsItemHovered()) widget::tooltip(on ? "Turn this layer off" : "Turn this layer on");
  widget::text_at(ImGui::GetWindowDrawList(), ImGui::GetFont(), at, on ? theme().quiet : theme().faint,
                  on ? icon::eye : icon::eye_closed);
  ImGui::SetCursorScreenPos({at.x + px(22), at.y});
  if (ui.renaming == index) {
    ImGui::SetCursorScreenPos({at.x + px(18), start.y});
    ImGui::SetNextItemWidth(-FLT_MIN);
    ImGui::SetKeyboardFocusHere();
    const bool done = ImGui::InputText("##name", &ui.new_name,
                                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    if (done) session.rename_layer(index, ui.new_name);
    if (done || ImGui::IsItemDeactivated()) ui.renaming = ~std::size_t{0};
  } else {
    widget::text_cut(name_of(layer, index), room, on ? theme().text : theme().faint);
    widget::value_right(about, theme().faint);
    if (renames) {
      ui.renaming = index;
      ui.new_name = name_of(layer, index);
    }
  }
  end_row(start);
  ImGui::PopID();
}

void show_scene(Ui& ui) {
  Session& session = ui.context.session;
  const ImVec2 start = ImGui::GetCursorScreenPos();
  widget::heading("SCENE", true);
  const ImVec2 after = ImGui::GetCursorScreenPos();
  const float side = px(20);
  ImGui::SetCursorScreenPos({start.x + ImGui::GetContentRegionAvail().x - side + px(2), start.y + px(4)});
  if (widget::icon_button(icon::plus, "add layer", false, side, theme().quiet, "A new layer above the others")) {
    if (session.methods().size() == 1)
      session.add_layer(session.methods()[0].name);
    else
      ImGui::OpenPopup("methods");
  }
  if (ImGui::BeginPopup("methods")) {
    for (const Method& method : session.methods()) {
      if (ImGui::MenuItem(method.name.c_str())) session.add_layer(method.name);
      if (ImGui::IsItemHovered()) widget::tooltip(method.help);
    }
    ImGui::EndPopup();
  }
  ImGui::SetCursorScreenPos(after);
  show_input(ui);
  for (std::size_t i = 0; i < session.project().layers.size(); ++i) show_layer(ui, i);
}

using widget::pop_fields;
using widget::push_fields;

void show_setting(Ui& ui, std::size_t layer, const Setting& setting) {
  Session& session = ui.context.session;
  ImGui::PushID(setting.name.c_str());
  widget::label(title_of(setting.name), setting.help);
  double value = session.setting(layer, setting);
  if (!setting.choices.empty()) {
    auto chosen = static_cast<std::size_t>(std::max(0.0, value));
    if (widget::choice("##value", chosen, setting.choices))
      session.set_setting(layer, setting.name, setting.choices[chosen]);
  } else {
    const std::string name = fmt::format("{}/{}", layer, setting.name);
    double shown = ui.edited_name == name ? ui.edited_value : value;
    const widget::Number described{setting.min, setting.max, setting.integer, false, setting.unit.c_str()};
    const bool done = widget::number("##value", shown, described);
    if (ImGui::IsItemActive()) {
      ui.edited_name = name;
      ui.edited_value = shown;
    } else if (ui.edited_name == name) {
      ui.edited_name.clear();
    }
    if (done) session.set_setting(layer, setting.name, shown);
  }
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) widget::tooltip(setting.help);
  ImGui::PopID();
}

void show_method(Ui& ui, std::size_t index) {
  Session& session = ui.context.session;
  if (session.methods().size() < 2) return;
  std::vector<std::string> names;
  std::size_t chosen = 0;
  for (const Method& method : session.methods()) {
    if (method.name == session.layer()->method) chosen = names.size();
    names.push_back(method.name);
  }
  widget::label("Method", session.methods()[chosen].help);
  if (widget::choice("##method", chosen, names)) session.set_method(index, names[chosen]);
}

void show_settings(Ui& ui) {
  Session& session = ui.context.session;
  const document::Layer* layer = session.layer();
  if (layer == nullptr) return;
  const std::size_t index = session.chosen_layer();
  widget::heading(upper(name_of(*layer, index)) + " · " + upper(layer->method));
  push_fields();
  show_method(ui, index);
  if (const document::Layer* now = session.layer(); now != nullptr) {
    for (const Method& method : session.methods())
      if (method.name == now->method)
        for (const Setting& setting : method.settings) show_setting(ui, index, setting);
  }
  show_motion(ui);
  pop_fields();
}

/// A coloured dot, a name, a value; true when clicked.
bool mark_row(const char* id, const ImVec4& color, const char* name, const std::string& value, bool chosen,
              const std::string& help, float indent = 0) {
  const ImVec2 start = ImGui::GetCursorScreenPos();
  const bool pressed = row(id, chosen, indent);
  if (ImGui::IsItemHovered() && !help.empty()) widget::tooltip(help);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddCircleFilled({start.x + indent + px(5), start.y + 0.5f * px(measure::row)}, px(5),
                                              packed(color), 24);
  ImGui::SetCursorScreenPos({at.x + px(20), at.y});
  ImGui::TextUnformatted(name);
  widget::value_right(value, theme().faint);
  end_row(start);
  return pressed;
}

/// Rows of rigid regions and of stiffness, where the layer's method knows them.
void show_material(Ui& ui) {
  Session& session = ui.context.session;
  const MarkCounts& marks = ui.marks;
  const document::Layer* layer = session.layer();
  if (layer == nullptr || session.method() == nullptr) return;
  const Method::Parts& parts = session.method()->parts;
  if (parts.rigid || marks.rigid > 0) {
    const std::size_t groups = layer->rigid.size();
    std::string value = marks.rigid == 0 ? "none" : grouped(marks.rigid) + " points";
    if (groups > 1) value = fmt::format("{} · {}", groups, value);
    if (mark_row("rigid", theme().rigid, "Rigid", value, false, "Regions that turn as one; click to select them"))
      session.select_rigid();
  }
  const auto stiffness_row = [&](const char* id, double like, const char* name, std::size_t points) {
    if (mark_row(id, stiffness_tint(like), name, points == 0 ? "none" : grouped(points) + " points", false,
                 "Click to select the points whose stiffness is changed"))
      session.select_stiff();
  };
  if (parts.stiffness || marks.stiffer > 0) stiffness_row("stiffer", 4, "Stiffer", marks.stiffer);
  if (parts.stiffness || marks.softer > 0) stiffness_row("softer", 0.25, "Softer", marks.softer);
}

void show_marks(Ui& ui) {
  Session& session = ui.context.session;
  widget::heading("MARKS");
  const std::vector<HandleView> handles = session.handles();
  const std::size_t fixed = ui.marks.fixed;
  const std::string count = handles.empty() ? "none" : std::to_string(handles.size());
  if (mark_row("handles", theme().handle, "Handles", count, false, "Click to select all points of the handles")) {
    session.select_none();
    for (std::size_t i = 0; i < handles.size(); ++i) session.select_handle(i);
  }
  if (handles.size() > 1 && handles.size() <= 8) {
    for (std::size_t i = 0; i < handles.size(); ++i) {
      ImGui::PushID(static_cast<int>(i));
      const std::string name = name_of_handle(*session.layer(), i);
      if (mark_row("handle", theme().handle, name.c_str(), grouped(handles[i].points) + " points",
                   session.chosen_handle() == i, "Click to choose this handle", px(20)))
        session.choose_handle(i);
      ImGui::PopID();
    }
  }
  if (mark_row("fixed", theme().fixed, "Fixed", fixed == 0 ? "none" : grouped(fixed) + " points", false,
               "Click to select the fixed points"))
    session.select_fixed();
  show_material(ui);
  if (session.layer() != nullptr && !session.layer()->cuts.empty())
    if (mark_row("cuts", theme().warning, "Cuts", std::to_string(session.layer()->cuts.size()), false,
                 "Click to remove the last cut"))
      session.remove_cut();
  const std::size_t selected = session.selection().count();
  if (mark_row("selected", ImVec4(1, 0.82f, 0.54f, 1), "Selected",
               selected == 0 ? "none" : grouped(selected) + " points", false, "Click to select nothing"))
    session.select_none();
  if (const std::size_t hidden = session.hidden().count(); hidden > 0)
    if (mark_row("hidden", theme().faint, "Hidden", grouped(hidden) + " points", false, "Click to show them"))
      session.show_hidden();
}

/// Axis and place of the plane that cuts the tets.
void show_section(gpu::Section& section) {
  widget::label("Cut across", "The axis that the plane of the cut is perpendicular to");
  const std::vector<std::string> axes{"X", "Y", "Z"};
  auto axis = static_cast<std::size_t>(section.axis);
  if (widget::choice("##axis", axis, axes)) section.axis = static_cast<int>(axis);
  widget::label("Cut at", "How much of the shape along that axis is shown");
  auto percent = static_cast<float>(100 * section.at);
  if (widget::slider("##at", percent, 0, 100, "%.0f %%")) section.at = static_cast<double>(percent) / 100;
}

/// A whole number in its row.
void whole(const char* name, const char* help, int most, const char* unit, int& value) {
  widget::label(name, help);
  ImGui::PushID(name);
  double shown = value;
  widget::number("##value", shown, {1, static_cast<double>(most), true, false, unit});
  value = static_cast<int>(shown);
  ImGui::PopID();
}

void show_onion(View& view) {
  whole("Ghosts", "So many before the frame shown, and so many after it", 8, "each side", view.onion_frames);
  whole("Apart", "Frames from one ghost to the next", 100, "frames", view.onion_step);
}

void show_look(Ui& ui) {
  View& view = ui.context.view;
  widget::heading("SHOW");
  push_fields();
  show_coloring(ui);
  if (!ui.stage.is_mesh() && !ui.stage.is_splats()) {
    widget::label("Point size", "Diameter of a point on the screen");
    auto size = static_cast<float>(view.point_size);
    if (widget::slider("##size", size, 1, 8, "%.1f px")) {
      view.point_size = std::round(2 * static_cast<double>(size)) / 2;
      ui.context.preferences.point_size = view.point_size;
    }
  }
  const auto toggle = [](const char* name, const char* help, bool& on) {
    widget::label(name, help);
    ImGui::PushID(name);
    widget::checkbox("##on", on);
    ImGui::PopID();
  };
  if (ui.context.session.layer() != nullptr)
    toggle("Structure", "Nodes, or tets, and edges that the chosen layer's method bends", view.show_graph);
  if (ui.context.session.layer() != nullptr && ui.context.session.method() != nullptr &&
      ui.context.session.method()->parts.solid && view.show_graph) {
    toggle("Cut open", "The tets on one side of a plane through the shape, as a solid", view.cut_tets);
    if (view.cut_tets) show_section(view.section);
  }
  if (ui.context.session.layer() != nullptr && ui.context.session.layer()->markers)
    toggle("Markers", "Markers of the motion, hollow where they were not seen, and bones of its skeleton",
           view.show_markers);
  if (ui.context.session.layer() != nullptr)
    toggle("Rest shape", "A ghost of the shape before any edit", view.show_rest);
  toggle("Ground", "A grid below the shape", view.show_ground);
  if (ui.context.session.moves()) {
    toggle("Onion skin", "Ghosts of frames before and after, while nothing moves", view.show_onion);
    if (view.show_onion) show_onion(view);
  }
  pop_fields();
}

/// The left edge of the column, to drag.
void show_edge(Ui& ui) {
  const ImVec2 at{ui.layout.column - px(3), ui.layout.top};
  ImGui::SetCursorScreenPos(at);
  ImGui::InvisibleButton("edge", {px(6), ui.layout.bottom - ui.layout.top});
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (ImGui::IsItemActive()) ui.column_width = (ui.layout.width - ImGui::GetIO().MousePos.x) / scale();
}

}  // namespace

void show_column(Ui& ui) {
  if (!ui.context.session.has_input() || !ui.column_open) return;
  const float width = ui.layout.width - ui.layout.column;
  widget::begin_panel("column frame", {ui.layout.column - px(3), ui.layout.top},
                      {px(6), ui.layout.bottom - ui.layout.top}, ImGuiWindowFlags_NoBackground);
  show_edge(ui);
  ImGui::End();
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  widget::begin_panel("column", {ui.layout.column, ui.layout.top}, {width, ui.layout.bottom - ui.layout.top});
  widget::edge_line({0, 0}, {0, 1});
  ImGui::SetCursorPos({px(1), 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(measure::pad), px(4)));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(8), 0));
  ImGui::BeginChild("rows", {0, 0}, false, ImGuiWindowFlags_AlwaysUseWindowPadding | ImGuiWindowFlags_NoNav);
  show_scene(ui);
  show_settings(ui);
  show_examples(ui);
  show_marks(ui);
  show_look(ui);
  ImGui::Dummy({0, px(8)});
  ImGui::EndChild();
  ImGui::PopStyleVar(2);
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace sinew::editor
