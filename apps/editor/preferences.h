#pragma once
/// Preferences: what the user chose for all sessions, as a small JSON file. Written whole or not at all; a file that
/// can't be understood is put aside as a notice and the standard values are used.

#include <string>
#include <vector>

#include "apps/editor/navigation.h"

namespace sinew::editor {

struct Preferences {
  bool asked_navigation = false;  ///< the first start asks for the preset
  NavigationPreset navigation = NavigationPreset::Blender;
  bool dark = true;
  double scale = 0;  ///< of the display: 1, 1.5, 2, 3; 0: the system's
  gpu::UpAxis up = gpu::UpAxis::Y;
  double point_size = 2;            ///< pixels, 1..16
  double brush_radius = 24;         ///< pixels, 2..500
  bool native_dialogs = true;       ///< the desktop's file dialog where there is one
  bool through = false;             ///< selection reaches what stands behind
  std::vector<std::string> recent;  ///< absolute paths, newest first, at most 12
  bool operator==(const Preferences&) const = default;
};

/// $XDG_CONFIG_HOME/sinew/editor.json, or ~/.config/sinew/editor.json; empty where neither is known.
std::string preferences_path();

struct LoadedPreferences {
  Preferences preferences;
  std::string notice;  ///< a sentence where the file was there but not understood; the file is left as it is
};
/// A missing file gives the standard values and no notice.
LoadedPreferences load_preferences(const std::string& path);

/// Makes the folder where it is missing. Returns a sentence where it can't be written, otherwise nothing: a window goes
/// on without its preferences.
std::string save_preferences(const std::string& path, const Preferences& preferences);

/// To the front of the recent files, each once.
void add_recent(Preferences& preferences, const std::string& path);

}  // namespace sinew::editor
