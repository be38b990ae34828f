#include "engine/geometry/error.h"

namespace sinew {

static std::string sentence(std::string place, const std::string& expected, const std::string& found) {
  return place + ": expected " + expected + ", found " + found;
}

InputError text_error(const std::string& path, std::int64_t line, std::int64_t column, const std::string& expected,
                      const std::string& found) {
  std::string place = path + ":" + std::to_string(line);
  if (column > 0) place += ":" + std::to_string(column);
  return InputError(sentence(place, expected, found));
}

InputError byte_error(const std::string& path, std::int64_t byte, const std::string& expected,
                      const std::string& found) {
  return InputError(sentence(path + ": byte " + std::to_string(byte), expected, found));
}

InputError file_error(const std::string& path, const std::string& expected, const std::string& found) {
  return InputError(sentence(path, expected, found));
}

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  static const char* const hex = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text.substr(0, longest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte >= 0x7f) {
      out += "\\x";
      out += hex[byte >> 4];
      out += hex[byte & 15];
    } else {
      out += c;
    }
  }
  return out + (text.size() > longest ? "\"..." : "\"");
}

}  // namespace sinew
