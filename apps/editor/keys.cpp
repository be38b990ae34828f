#include "apps/editor/keys.h"

#include <array>
#include <cctype>

namespace sinew::editor {

namespace {

struct KeyName {
  const char* name;
  int key;
};
constexpr std::array key_names{
    KeyName{"Space", key::space},
    KeyName{"Esc", key::escape},
    KeyName{"Enter", key::enter},
    KeyName{"Tab", key::tab},
    KeyName{"Backspace", key::backspace},
    KeyName{"Insert", key::insert},
    KeyName{"Delete", key::del},
    KeyName{"Right", key::right},
    KeyName{"Left", key::left},
    KeyName{"Down", key::down},
    KeyName{"Up", key::up},
    KeyName{"Page Up", key::page_up},
    KeyName{"Page Down", key::page_down},
    KeyName{"Home", key::home},
    KeyName{"End", key::end},
    KeyName{"Num .", key::pad_decimal},
    KeyName{"Num /", key::pad_divide},
    KeyName{"Num *", key::pad_multiply},
    KeyName{"Num -", key::pad_subtract},
    KeyName{"Num +", key::pad_add},
    KeyName{"Num Enter", key::pad_enter},
};

std::optional<int> key_of(std::string_view name) {
  for (const KeyName& row : key_names)
    if (name == row.name) return row.key;
  if (name.size() == 5 && name.starts_with("Num ") && name[4] >= '0' && name[4] <= '9')
    return key::pad_0 + (name[4] - '0');
  if (name.size() >= 2 && name.size() <= 3 && name[0] == 'F') {
    int number = 0;
    for (const char c : name.substr(1)) {
      if (c < '0' || c > '9') return std::nullopt;
      number = 10 * number + (c - '0');
    }
    if (number >= 1 && number <= 25) return key::f1 + number - 1;
    return std::nullopt;
  }
  // Letters stand for their key, whatever their case; '?' needs Shift and is treated by chord_of().
  if (name.size() == 1 && name[0] > ' ' && name[0] <= '~' && !std::islower(static_cast<unsigned char>(name[0])))
    return name[0];
  return std::nullopt;
}

}  // namespace

std::optional<Chord> chord_of(std::string_view text) {
  Chord chord;
  for (const auto& [name, bit] : {std::pair<std::string_view, int>{"Ctrl+", modifier::control},
                                  {"Shift+", modifier::shift},
                                  {"Alt+", modifier::alt}}) {
    if (!text.starts_with(name)) continue;
    chord.modifiers |= bit;
    text.remove_prefix(name.size());
  }
  if (text == "?") return Chord{'/', chord.modifiers | modifier::shift};
  const std::optional<int> found = key_of(text);
  if (!found) return std::nullopt;
  chord.key = *found;
  return chord;
}

std::string name_of(const Chord& chord) {
  std::string out;
  if (chord.key == '/' && chord.modifiers == modifier::shift) return "?";
  if (chord.modifiers & modifier::control) out += "Ctrl+";
  if (chord.modifiers & modifier::shift) out += "Shift+";
  if (chord.modifiers & modifier::alt) out += "Alt+";
  for (const KeyName& row : key_names)
    if (chord.key == row.key) return out + row.name;
  if (chord.key >= key::pad_0 && chord.key <= key::pad_0 + 9)
    return out + "Num " + std::to_string(chord.key - key::pad_0);
  if (chord.key >= key::f1 && chord.key < key::f1 + 25) return out + "F" + std::to_string(chord.key - key::f1 + 1);
  if (chord.key > ' ' && chord.key <= '~') return out + static_cast<char>(chord.key);
  return {};
}

bool matches(const Chord& chord, int key, int modifiers) {
  return chord.key == key && chord.modifiers == (modifiers & modifier::all);
}

}  // namespace sinew::editor
