#pragma once
/// Words of text files, whatever their case and the blanks around them.

#include <string_view>

#include "engine/io/text.h"

namespace sinew::io {

inline std::string_view trimmed(std::string_view text) {
  while (!text.empty() && TextCursor::is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && TextCursor::is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Equal but for the case of ASCII letters.
inline bool same_word(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (lower(a[i]) != lower(b[i])) return false;
  return true;
}

}  // namespace sinew::io
