#include "apps/editor/input.h"

#include <fmt/core.h>

#include <array>
#include <chrono>
#include <sstream>

#include "engine/geometry/error.h"

namespace sinew::editor {

namespace {

using What = InputEvent::What;
constexpr std::array<const char*, 9> names{"move", "button", "wheel", "key",  "text",
                                           "drop", "resize", "focus", "close"};

bool read_fields(std::istringstream& line, InputEvent& event) {
  switch (event.what) {
    case What::Move:
    case What::Wheel:
    case What::Resize: return static_cast<bool>(line >> event.x >> event.y);
    case What::Button:
    case What::Key: return static_cast<bool>(line >> event.code >> event.action >> event.modifiers);
    case What::Text: return static_cast<bool>(line >> event.code);
    case What::Focus: return static_cast<bool>(line >> event.action);
    case What::Close: return true;
    case What::Drop: break;
  }
  std::string path;
  while (std::getline(line >> std::ws, path, '\t')) event.paths.push_back(path);
  return !event.paths.empty();
}

}  // namespace

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string text_of(const InputEvent& event, double start) {
  std::string line = fmt::format("{:.4f} {}", event.time - start, names[static_cast<std::size_t>(event.what)]);
  switch (event.what) {
    case What::Move:
    case What::Wheel:
    case What::Resize: return line + fmt::format(" {} {}", event.x, event.y);
    case What::Button:
    case What::Key: return line + fmt::format(" {} {} {}", event.code, event.action, event.modifiers);
    case What::Text: return line + fmt::format(" {}", event.code);
    case What::Focus: return line + fmt::format(" {}", event.action);
    case What::Close: return line;
    case What::Drop: break;
  }
  for (std::size_t i = 0; i < event.paths.size(); ++i) line += (i == 0 ? " " : "\t") + event.paths[i];
  return line;
}

std::deque<InputEvent> parse_events(const std::string& path, const std::string& text) {
  std::deque<InputEvent> events;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream fields(line);
    InputEvent event;
    std::string name;
    fields >> event.time >> name;
    std::size_t what = 0;
    while (what < names.size() && name != names[what]) ++what;
    if (what == names.size())
      throw text_error(path, number, 0, "a time and move, button, wheel, key, ...", quoted(line));
    event.what = static_cast<What>(what);
    if (!read_fields(fields, event)) throw text_error(path, number, 0, "the fields of " + name, quoted(line));
    events.push_back(std::move(event));
  }
  return events;
}

}  // namespace sinew::editor
