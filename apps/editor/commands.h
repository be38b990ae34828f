#pragma once
/// Commands: one table from which menus, shortcuts, the help and the palette are made. A new command is a function and
/// a row. What only a window can do (dialogs, leaving) a command asks of it by a Request.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/editor/keys.h"
#include "apps/editor/preferences.h"
#include "apps/editor/session.h"
#include "apps/editor/view.h"

namespace sinew::editor {

enum class Request {
  Open,
  OpenRun,
  AddPoses,
  AddControlPoints,
  SaveAs,
  Export,
  Screenshot,
  Turntable,
  TurntableName,
  CopyCommand,
  Palette,
  Keymap,
  About,
  Preferences,
  NavigationChoice,
  Column,
  Quit
};

/// All that a command may touch.
struct Context {
  Session& session;
  View& view;
  Preferences& preferences;
  std::function<void(Request)> request;
};

struct Command {
  const char* id;        ///< "edit.undo": never changes
  const char* title;     ///< "Undo"
  const char* menu;      ///< "Edit", "Select/Shape": a path; rows of one menu stand in the table's order
  const char* shortcut;  ///< "Ctrl+Z" or several, "Delete, X"; empty: none
  const char* help;      ///< one sentence
  bool (*enabled)(const Context&);
  void (*run)(Context&);
  bool (*checked)(const Context&) = nullptr;  ///< of a switch: whether it is on
  bool separator = false;                     ///< a line above it in its menu
  /// Why it is not enabled, where that needs saying: one sentence; empty: for reasons that are plain to see.
  std::string (*why_not)(const Context&) = nullptr;
};

std::span<const Command> commands();
const Command* find_command(std::string_view id);

/// The chords of `shortcut`, for showing and matching.
std::vector<Chord> shortcuts_of(const Command& command);

/// The enabled command of a pressed key; null where there is none. Commands come first to last: of two with one
/// shortcut the first that is enabled.
const Command* command_for(int key, int modifiers, const Context& context);

/// What to tell who presses a key of a command that is not enabled; empty: nothing.
std::string why_no_command_for(int key, int modifiers, const Context& context);

/// Runs it where it is enabled; false where it is not.
bool run_command(const Command& command, Context& context);

/// For a palette: commands whose title, menu or help have all words of `text`, best first; all of them for no words.
std::vector<const Command*> search_commands(std::string_view text);

}  // namespace sinew::editor
