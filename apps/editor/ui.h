#pragma once
/// Ui: what the panels share, and a function a panel. They are shown from top to bottom once a frame.

#include <optional>
#include <string>
#include <vector>

#include "apps/editor/commands.h"
#include "apps/editor/legend.h"
#include "apps/editor/mouse.h"
#include "apps/editor/recovery.h"
#include "apps/editor/stage.h"
#include "apps/editor/ui_files.h"
#include "apps/editor/window.h"

namespace sinew::editor {

/// Where things are in this frame, pixels.
struct Layout {
  float width = 0, height = 0;
  float top = 0;     ///< below the menu bar
  float bottom = 0;  ///< above the timeline, or the status line where there is none
  float status = 0;  ///< above the status line
  float column = 0;  ///< left edge of the right column
};

struct Toast {
  Notice notice;
  double since = 0;
};

/// How many points the chosen layer marks.
struct MarkCounts {
  std::size_t fixed = 0, rigid = 0, stiffer = 0, softer = 0;
};

/// A question before something is lost; shown while its text is not empty.
struct Question {
  std::string text, action;
  std::function<void()> confirmed;
};

/// What a turntable is to be.
struct TurntableChoice {
  int pictures = 60, width = 1280, height = 720;
  double degrees = 360;
};

/// A drag of the legend's ends that runs.
struct LegendDrag {
  LegendPart part = LegendPart::None;
  document::ValueRange domain, before;
  float from = 0;  ///< pixels, where it began
};

struct Ui {
  Context& context;
  Stage& stage;
  Mouse& mouse;
  std::string device;                 ///< "llvmpipe, CPU skinning"
  std::string sample;                 ///< path of the sample scan; empty: none
  std::vector<std::string> pictured;  ///< recent files that fonts().pictures show, in that order
  MarkCounts marks;
  Layout layout;
  float column_width = 272;  ///< at scale 1
  bool column_open = true;
  FileDialog files;
  std::vector<Toast> toasts;
  bool palette = false, keymap = false, about = false, settings = false, navigation_choice = false;
  bool turntable = false;
  TurntableChoice turntable_choice;
  LegendDrag legend;
  std::optional<Job> drawing;  ///< pictures that are being written
  std::function<void()> cancel_drawing;
  Question ask;
  Recovery recovery{Window::wake};
  std::size_t history_seen = 0;  ///< the present step when the history was shown last
  std::string palette_text;
  int palette_row = 0;
  std::size_t renaming = ~std::size_t{0};  ///< layer whose name is being typed
  std::string new_name;
  std::string edited_name;  ///< "layer/setting" of the number that is being dragged or typed, and what it is so far
  double edited_value = 0;
  std::optional<int> moved_key;  ///< that is being dragged along the timeline, to
  int moved_key_to = 0;
  bool wants_frames = false;  ///< something in the interface moves by itself
  double next_frame = 1e300;  ///< when, by now(), the interface will change by itself

  bool dialog() const {
    return files.shown() || palette || keymap || about || settings || navigation_choice || turntable ||
           !ask.text.empty() || recovery.offered() != nullptr;
  }
};

/// The layout for a picture of this size.
Layout layout_of(const Ui& ui, float width, float height);
/// All of it.
void show_ui(Ui& ui);

void show_menu(Ui& ui);
void show_tools(Ui& ui);          ///< tool bar at the left, switches at the top
float tools_right(const Ui& ui);  ///< where the room beside the tool bar begins, pixels
void show_column(Ui& ui);         ///< scene, layer, marks, show
void show_motion(Ui& ui);         ///< of the chosen layer: rows of its settings
void show_examples(Ui& ui);       ///< of the chosen layer: a row each, with its weight
void show_status(Ui& ui);
void show_timeline(Ui& ui);           ///< of what moves: buttons, frame, keys
float timeline_height(const Ui& ui);  ///< pixels; 0 for a still
void show_start(Ui& ui);              ///< while nothing is open
void show_choosing(Ui& ui);           ///< panel of the box, sphere or range that selects now
ImVec4 choosing_panel(const Ui& ui);  ///< its left, top, width and height, pixels; nothing where it is not shown
void show_residuals(Ui& ui);          ///< table of how far handles are from their targets
void show_job(Ui& ui);
void show_toasts(Ui& ui);
void show_history(Ui& ui);
void show_recovery(Ui& ui);
void show_legend(Ui& ui);         ///< of what the colours stand for, beside the scene
float legend_left(const Ui& ui);  ///< its left edge, pixels; that of the column where it is not shown
void show_coloring(Ui& ui);       ///< rows of the column
void show_turntable(Ui& ui);      ///< the dialog
void show_palette(Ui& ui);
void show_keymap(Ui& ui);
void show_dialogs(Ui& ui);  ///< about, settings, navigation
/// Gizmo, axes, lasso, brush, measures: over the scene, below the panels.
void show_overlay(Ui& ui);

/// The polygon, the ball of the sphere brush, the volume that selects; and a part of show_overlay.
void draw_selecting(Ui& ui, ImDrawList* list);

/// "1,234,567".
std::string grouped(std::size_t number);
/// Shows a command's tooltip and runs it when its button is pressed.
bool command_button(Ui& ui, const char* command, const char* icon, float side, const ImVec4& color, bool chosen);
void run(Ui& ui, const char* command);

}  // namespace sinew::editor
