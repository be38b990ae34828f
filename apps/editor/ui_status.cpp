#include <fmt/format.h>
#include <imgui.h>

#include <cmath>

#include "apps/editor/gui.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

namespace {

/// With its sign, but 0 without.
std::string percent(double share) {
  return std::abs(share) < 5e-4 ? "0.0 %" : fmt::format("{:+.1f} %", 100 * share);
}

/// A run of the status line: what is told in bright, what it is about in quiet.
struct Piece {
  std::string text;
  bool bright = false;
};
/// Pieces that stand or go together; the higher the rank, the sooner it goes where there is no room.
struct Group {
  std::vector<Piece> pieces;
  int rank = 0;
};

ImFont* font_of(const Piece& piece) {
  return piece.bright ? fonts().bold : fonts().text;
}

float width_of(const Group& group) {
  float width = 0;
  for (const Piece& piece : group.pieces) width += widget::size_of(font_of(piece), piece.text).x;
  return width;
}

float width_of(const std::vector<Group>& groups) {
  float width = 0;
  for (const Group& group : groups) width += width_of(group) + px(20);
  return width;
}

std::vector<Group> figures(const Ui& ui) {
  const Session& session = ui.context.session;
  std::vector<Group> out;
  if (!session.has_input()) return out;
  if (session.layer() == nullptr || session.shown().empty()) {
    const std::size_t faces = session.input()->faces.size();
    out.push_back({{{grouped(session.input()->size()), true}, {" points", false}}, 0});
    if (faces > 0) out.push_back({{{grouped(faces), true}, {" faces", false}}, 1});
    if (!session.selection().empty())
      out.push_back({{{grouped(session.selection().count()), true}, {" selected", false}}, 0});
    return out;
  }
  const StatusFigures& figures = session.figures();
  out.push_back({{{fmt::format("{}", figures.iterations), true},
                  {figures.iterations == 1 ? " iteration · " : " iterations · ", false},
                  {fmt::format("{:.1f}", figures.milliseconds), true},
                  {" ms", false}},
                 0});
  if (figures.build_seconds > 0)
    out.push_back({{{"prepared in ", false}, {fmt::format("{:.2f}", figures.build_seconds), true}, {" s", false}}, 4});
  out.push_back({{{"residual ", false}, {fmt::format("{:.1e}", figures.residual), true}}, 3});
  out.push_back({{{"max stretch ", false}, {percent(figures.max_stretch), true}}, 2});
  out.push_back({{{"moved ", false},
                  {(figures.sampled && figures.moved > 0 ? "~" : "") + grouped(figures.moved), true},
                  {" of " + grouped(session.input()->size()), false}},
                 1});
  if (!session.selection().empty())
    out.push_back({{{grouped(session.selection().count()), true}, {" selected", false}}, 0});
  return out;
}

Group key(const char* what, const char* keys, int rank) {
  if (what[0] == 0) return {{{keys, true}}, rank};
  return {{{keys, true}, {std::string(" ") + what, false}}, rank};
}

/// What the mouse buttons do now.
std::vector<Group> hints(const Ui& ui) {
  const View& view = ui.context.view;
  std::vector<Group> out;
  if (!ui.context.session.has_input()) return out;
  if (view.manipulation) {
    out.push_back({{{view.modal ? "click to set" : "drag handle", false}}, 0});
    out.push_back(key("axis", "X Y Z", 4));
    out.push_back(key("precise", "Shift", 2));
    out.push_back(key("snap", "Ctrl", 3));
    out.push_back(key("cancel", "Esc", 1));
    return out;
  }
  if (ui.mouse.in_polygon()) {
    out.push_back({{{"click corners", false}}, 0});
    out.push_back(key("closes", "Enter", 1));
    out.push_back(key("takes a corner back", "Backspace", 2));
    out.push_back(key("cancel", "Esc", 1));
    return out;
  }
  if (view.choosing) {
    if (view.choosing->volume() != nullptr) {
      out.push_back(key("move", "G", 1));
      out.push_back(key("size", "S", 1));
    }
    out.push_back(key("done", "Enter", 0));
    out.push_back(key("cancel", "Esc", 0));
    return out;
  }
  if (ui.mouse.stroking()) {
    out.push_back({{{ui.context.view.tool == Tool::Cut ? "let go to cut" : "let go to select", false}}, 0});
    out.push_back(key("cancel", "Esc", 1));
    return out;
  }
  const char* tools[] = {"click or drag to select",
                         "drag a handle",
                         "drag a handle",
                         "drag a handle's axes",
                         "drag to select",
                         "draw around to select",
                         "click corners",
                         "paint to select",
                         "paint with a sphere",
                         "click where a box or sphere is to be",
                         "draw where nothing is to pass"};
  out.push_back({{{tools[static_cast<std::size_t>(view.tool)], false}}, 1});
  out.push_back(key("adds", "Shift", 2));
  out.push_back(key("removes", "Ctrl", 2));
  for (const NavigationBinding& binding : navigation_bindings()) {
    if (binding.preset != ui.context.preferences.navigation || binding.action != NavigationAction::Orbit) continue;
    out.push_back({{{binding.help, false}}, 3});
    break;
  }
  return out;
}

/// Leaves out groups, those of the highest rank first, until both sides fit.
void fit(std::vector<Group>& left, std::vector<Group>& right, float room) {
  while (width_of(left) + width_of(right) > room && left.size() + right.size() > 0) {
    std::vector<Group>* from = &left;
    std::size_t worst = 0;
    int rank = -1;
    for (std::vector<Group>* side : {&left, &right})
      for (std::size_t i = 0; i < side->size(); ++i)
        if ((*side)[i].rank >= rank) {
          rank = (*side)[i].rank;
          from = side;
          worst = i;
        }
    from->erase(from->begin() + static_cast<std::ptrdiff_t>(worst));
  }
}

void draw(ImDrawList* list, float x, float middle, const std::vector<Group>& groups) {
  for (const Group& group : groups) {
    for (const Piece& piece : group.pieces) {
      const ImVec2 size = widget::size_of(font_of(piece), piece.text);
      widget::text_at(list, font_of(piece), {x, middle - 0.5f * size.y}, piece.bright ? theme().text : theme().quiet,
                      piece.text);
      x += size.x;
    }
    x += px(20);
  }
}

}  // namespace

void show_status(Ui& ui) {
  const float height = px(measure::status_line);
  widget::begin_panel("status", {0, ui.layout.status}, {ui.layout.width, height});
  std::vector<Group> left = figures(ui), right = hints(ui);
  if (!ui.device.empty()) right.push_back({{{ui.device, false}}, 5});
  fit(left, right, ui.layout.width - 2 * px(measure::pad) - px(8));
  ImDrawList* list = ImGui::GetWindowDrawList();
  const float middle = ui.layout.status + 0.5f * height;
  draw(list, px(measure::pad), middle, left);
  draw(list, ui.layout.width - px(measure::pad) - width_of(right) + px(20), middle, right);
  widget::edge_line({0, 0}, {1, 0});
  ImGui::End();
}

}  // namespace sinew::editor
