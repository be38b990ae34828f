#pragma once
/// Widgets: the few parts that all panels are made of, on the 4-pixel grid: rows of 24, labels in one column, fields in
/// the other, units inside the field at its right.

#include <imgui.h>

#include <span>
#include <string>

namespace sinew::editor::widget {

/// A window without title, border, moving or saving that stands exactly there. Ends with ImGui::End().
bool begin_panel(const char* name, ImVec2 position, ImVec2 size, ImGuiWindowFlags more = 0);
/// A line along one side of the present window: (0, 0)-(1, 0) is its upper edge.
void edge_line(ImVec2 from, ImVec2 to);

/// A window in the middle of a shaded rest; Esc and a click beside it set `shown` to false. False while it is not
/// shown; otherwise end_dialog() follows.
bool begin_dialog(bool& shown, const char* id, float width, float height);
void end_dialog(bool shown);

/// "SCENE": a heading in small capitals with room above; the first of a panel has less.
void heading(const std::string& text, bool first = false);
/// A label in its column, cut with "..." where it is too long; the next item stands in the other column and fills it.
void label(const std::string& text, const std::string& help = "");

/// Text that ends with "..." where it is wider than `width`, and then shows all of itself as a tooltip.
void text_cut(const std::string& text, float width, const ImVec4& color);
std::string cut(const std::string& text, float width);
/// `value` in quiet colour, flush right in the row that has begun.
void value_right(const std::string& value, const ImVec4& color);

/// Fields are 20 high and 4 apart, rows of 24, from the first to the second.
void push_fields();
void pop_fields();

/// A number that can be dragged sideways, clicked and typed. True when a change is finished (let go, Enter).
struct Number {
  double min = 0, max = 1;
  bool integer = false;
  bool logarithmic = false;
  const char* unit = "";  ///< shown at the right, inside
  double speed = 0;       ///< of a pixel of the mouse; 0: by the value
  int digits = 4;
};
bool number(const char* id, double& value, const Number& described);
/// A choice of names. True when another one was taken.
bool choice(const char* id, std::size_t& chosen, std::span<const std::string> names);
bool checkbox(const char* id, bool& on);
/// A bar to drag. True while it is dragged.
bool slider(const char* id, float& value, float min, float max, const char* format);

/// What happened to a bar in this frame.
struct BarUse {
  bool begun = false, changed = false, ended = false, cancelled = false;
};
/// A bar from 0 to `value`, with marks at 0 and 1, to drag between `min` and `max`; Ctrl and a click types any number.
/// `lit`: in the accent's colour.
BarUse bar(const char* id, double& value, double min, double max, bool lit);

/// A square button of an icon, with a tooltip (`shortcut` may be empty). Colour: of the icon.
bool icon_button(const char* icon, const char* id, bool chosen, float side, const ImVec4& color,
                 const std::string& help, const std::string& shortcut = "");
/// Buttons side by side, one of which is chosen. Returns the one that was pressed, or -1.
int switch_of(const char* id, std::span<const char* const> names, int chosen, std::span<const char* const> help);
/// A button with text; `primary` in the accent's colour.
bool button(const char* text, bool primary, float width = 0);

void tooltip(const std::string& text, const std::string& shortcut = "");
/// Size of text in a font, in pixels.
ImVec2 size_of(ImFont* font, const std::string& text);
void text_at(ImDrawList* list, ImFont* font, ImVec2 at, const ImVec4& color, const std::string& text);

}  // namespace sinew::editor::widget
