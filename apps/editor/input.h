#pragma once
/// Input: what mouse, keyboard and window system told the program, as plain data with a time each. Everything that the
/// editor does starts from these events and from nothing else, so that a recorded list of them, played again, does the
/// same: a bug report is a file.

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace sinew::editor {

struct InputEvent {
  enum class What : std::uint8_t { Move, Button, Wheel, Key, Text, Drop, Resize, Focus, Close };
  What what = What::Move;
  double time = 0;                 ///< seconds on the clock of now()
  double x = 0, y = 0;             ///< Move: pixels of the picture; Wheel: steps; Resize: size in pixels
  int code = 0;                    ///< Button: 0 left, 1 right, 2 middle; Key: of GLFW; Text: code point
  int action = 0;                  ///< Button, Key: 1 pressed, 0 let go, 2 repeated; Focus: 1 gained
  int modifiers = 0;               ///< bits of GLFW_MOD_*
  std::vector<std::string> paths;  ///< Drop
};

/// Seconds on a clock that only goes forward.
double now();

/// One event a line: "1.250 move 640 360". Times count from the first event.
std::string text_of(const InputEvent& event, double start);

/// Events of a recorded text, in order, times as written. Throws InputError: "PATH:LINE: expected ..., found ...".
std::deque<InputEvent> parse_events(const std::string& path, const std::string& text);

}  // namespace sinew::editor
