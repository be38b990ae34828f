#include "apps/editor/ui.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/editor/input.h"
#include "apps/editor/theme.h"

namespace sinew::editor {

Layout layout_of(const Ui& ui, float width, float height) {
  Layout layout;
  layout.width = width;
  layout.height = height;
  layout.top = px(measure::menu_bar);
  layout.status = height - px(measure::status_line);
  layout.bottom = layout.status - timeline_height(ui);
  const bool column = ui.context.session.has_input() && ui.column_open;
  const float column_width = std::clamp(px(ui.column_width), px(240), std::max(px(240), 0.5f * width));
  layout.column = column ? std::round(width - column_width) : width;
  return layout;
}

void show_ui(Ui& ui) {
  show_overlay(ui);
  show_menu(ui);
  show_tools(ui);
  show_column(ui);
  show_history(ui);
  show_start(ui);
  show_legend(ui);
  show_timeline(ui);
  show_status(ui);
  show_choosing(ui);
  show_residuals(ui);
  show_job(ui);
  show_toasts(ui);
  show_palette(ui);
  show_keymap(ui);
  show_dialogs(ui);
  show_recovery(ui);
  show_turntable(ui);
  if (ui.files.looking()) ui.next_frame = std::min(ui.next_frame, now() + 0.05);
  ui.files.show(ui.context.preferences.recent);
}

}  // namespace sinew::editor
