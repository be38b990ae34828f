#include "apps/editor/preferences.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <span>

#include "apps/editor/background.h"
#include "engine/document/json.h"
#include "engine/io/io.h"

namespace sinew::editor {

/// The file: choices by name, so that it can be read and mended by hand.
struct PreferencesFile {
  Preferences values;
};

namespace {

constexpr std::array navigation_names{"blender", "maya", "scan"};
constexpr std::array theme_names{"dark", "light"};
constexpr std::array up_names{"y", "z"};
constexpr std::size_t most_recent = 12;

constexpr document::Range point_sizes{[](double x) { return x >= 1 && x <= 16; }, "a number of pixels from 1 to 16"};
constexpr document::Range brush_radii{[](double x) { return x >= 2 && x <= 500; }, "a number of pixels from 2 to 500"};
constexpr document::Range scales{[](double x) { return x == 0 || (x >= 0.5 && x <= 4); },
                                 "0 or a number from 0.5 to 4"};

/// A member whose value is one of `names`.
template <class A, std::size_t n>
void choice(A& a, const char* member, const std::array<const char*, n>& names, std::size_t& index) {
  std::string name = names[index];
  a.optional(member, name);
  if constexpr (A::reading) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      std::string expected = "one of";
      for (const char* known : names) expected += (known == names.front() ? " \"" : ", \"") + std::string(known) + "\"";
      throw a.file().error(*a.json().find(member), expected);
    }
    index = static_cast<std::size_t>(found - names.begin());
  }
}

}  // namespace

template <class A, class T>
requires std::is_same_v<std::remove_const_t<T>, PreferencesFile>
void fields(A& a, T& file) {
  Preferences p = file.values;
  std::size_t navigation = static_cast<std::size_t>(p.navigation), theme = p.dark ? 0 : 1;
  std::size_t up = p.up == gpu::UpAxis::Y ? 0 : 1;
  choice(a, "navigation", navigation_names, navigation);
  choice(a, "theme", theme_names, theme);
  choice(a, "up", up_names, up);
  a.optional("asked_navigation", p.asked_navigation);
  a.optional("scale", p.scale, scales);
  a.required("point_size", p.point_size, point_sizes);
  a.required("brush_radius", p.brush_radius, brush_radii);
  a.optional("native_dialogs", p.native_dialogs);
  a.optional("through", p.through);
  a.optional("recent", p.recent);
  if constexpr (A::reading) {
    p.navigation = static_cast<NavigationPreset>(navigation);
    p.dark = theme == 0;
    p.up = up == 0 ? gpu::UpAxis::Y : gpu::UpAxis::Z;
    if (p.recent.size() > most_recent) p.recent.resize(most_recent);
    file.values = std::move(p);
  }
}

}  // namespace sinew::editor

template <>
inline constexpr bool sinew::document::is_object<sinew::editor::PreferencesFile> = true;

namespace sinew::editor {

std::string preferences_path() {
  // Relative values of the variable are to be ignored [XDG Base Directory Specification].
  const char* configuration = std::getenv("XDG_CONFIG_HOME");
  if (configuration != nullptr && configuration[0] == '/') return std::string(configuration) + "/sinew/editor.json";
  const char* home = std::getenv("HOME");
  if (home != nullptr && home[0] == '/') return std::string(home) + "/.config/sinew/editor.json";
  return {};
}

LoadedPreferences load_preferences(const std::string& path) {
  LoadedPreferences out;
  std::error_code error;
  if (path.empty() || !std::filesystem::exists(path, error)) return out;
  const std::string failure = sentence_of_failure([&] {
    const std::vector<std::byte> bytes = io::load_bytes(path);
    const document::JsonFile file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    PreferencesFile read;
    document::read_value(file, file.root(), read);
    out.preferences = read.values;
  });
  if (!failure.empty()) out.notice = failure + "; the standard preferences are used";
  return out;
}

std::string save_preferences(const std::string& path, const Preferences& preferences) {
  if (path.empty()) return "expected a folder for preferences, found neither XDG_CONFIG_HOME nor HOME";
  return sentence_of_failure([&] {
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    document::JsonWriter out;
    document::write_value(out, PreferencesFile{preferences});
    io::save_bytes(path, std::as_bytes(std::span(out.result())), true);
  });
}

void add_recent(Preferences& preferences, const std::string& path) {
  const std::string absolute = std::filesystem::absolute(path).lexically_normal().string();
  std::vector<std::string>& recent = preferences.recent;
  std::erase(recent, absolute);
  recent.insert(recent.begin(), absolute);
  if (recent.size() > most_recent) recent.resize(most_recent);
}

}  // namespace sinew::editor
