#pragma once
/// Keys: codes and modifiers as GLFW has them (printable keys are their ASCII capitals), without its header, and chords
/// of them as text: "Ctrl+Shift+Z".

#include <optional>
#include <string>
#include <string_view>

namespace sinew::editor {

namespace key {
inline constexpr int space = 32, escape = 256, enter = 257, tab = 258, backspace = 259, insert = 260, del = 261,
                     right = 262, left = 263, down = 264, up = 265, page_up = 266, page_down = 267, home = 268,
                     end = 269, f1 = 290, pad_0 = 320, pad_decimal = 330, pad_divide = 331, pad_multiply = 332,
                     pad_subtract = 333, pad_add = 334, pad_enter = 335, left_shift = 340, left_control = 341,
                     left_alt = 342, right_shift = 344, right_control = 345, right_alt = 346;
}  // namespace key

namespace modifier {
inline constexpr int shift = 1, control = 2, alt = 4, super = 8, all = 15;
}  // namespace modifier

enum class MouseButton { Left = 0, Right = 1, Middle = 2 };

/// A key with modifiers.
struct Chord {
  int key = 0;
  int modifiers = 0;  ///< bits of modifier
  bool operator==(const Chord&) const = default;
};

/// "Ctrl+Shift+Z", "Home", "Num 7", "[", "F1", "?" (Shift and /). Nothing where the text is no chord.
std::optional<Chord> chord_of(std::string_view text);

/// The text that chord_of() reads back; empty for a key without a name.
std::string name_of(const Chord& chord);

/// Whether a pressed key is this chord; lock keys do not matter.
bool matches(const Chord& chord, int key, int modifiers);

}  // namespace sinew::editor
