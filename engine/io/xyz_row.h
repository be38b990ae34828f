#pragma once
/// Rows of an XYZ file: its lines, and the fields of a line. Shared by the reader of whole files and the streaming one.

#include <cstddef>
#include <string_view>

namespace sinew::io {

/// The fields of one line, separated by blanks and tabs, or by a comma or semicolon with blanks around it. A field in
/// quotes ends at its second quote and is given without them.
class XyzFields {
 public:
  explicit XyzFields(std::string_view line) : line_(line) { skip_blanks(); }

  /// The next field, a part of the line; false at the end of the line or where a comment begins. Two commas in a row
  /// give an empty field.
  bool next(std::string_view& field) {
    if (at_ == line_.size() || line_[at_] == '#' || line_.substr(at_).starts_with("//")) return false;
    if (quoted_field(field)) return true;
    const std::size_t begin = at_;
    while (at_ < line_.size() && !is_blank(line_[at_]) && !is_separator(line_[at_])) ++at_;
    field = line_.substr(begin, at_ - begin);
    skip_separator();
    return true;
  }

 private:
  bool quoted_field(std::string_view& field) {
    if (line_[at_] != '"') return false;
    const std::size_t end = line_.find('"', at_ + 1);
    if (end == std::string_view::npos) return false;
    field = line_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    skip_separator();
    return true;
  }
  void skip_separator() {
    skip_blanks();
    if (at_ == line_.size() || !is_separator(line_[at_])) return;
    ++at_;
    skip_blanks();
  }
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\r'; }
  static bool is_separator(char c) { return c == ',' || c == ';'; }
  void skip_blanks() {
    while (at_ < line_.size() && is_blank(line_[at_])) ++at_;
  }

  std::string_view line_;
  std::size_t at_ = 0;
};

/// What stands behind the sign of a comment line ("#", "//", ";"); its data() is null where the line is no comment.
inline std::string_view xyz_comment(std::string_view line) {
  const std::size_t begin = line.find_first_not_of(" \t\v\f");
  if (begin == std::string_view::npos) return {};
  line.remove_prefix(begin);
  if (line.front() == '#' || line.front() == ';') return line.substr(1);
  return line.starts_with("//") ? line.substr(2) : std::string_view{};
}

}  // namespace sinew::io
