#pragma once
/// Tokens of a text file with their place, and numbers both ways. '\n', "\r\n" and '\r' end a line.

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include "engine/geometry/error.h"

namespace sinew::io {

/// A run of characters without white space; `begin` is its byte in the file.
struct Token {
  std::string_view text;
  std::size_t begin = 0;
  std::int64_t line = 0, column = 0;  ///< from 1
};

/// A walk over lines and tokens. `text` must outlive the cursor.
class TextCursor {
 public:
  TextCursor(std::string path, std::string_view text, std::size_t at = 0, std::int64_t line = 1)
      : path_(std::move(path)), text_(text), at_(at), line_begin_(at), line_(line) {}

  bool at_end() const { return at_ >= text_.size(); }
  std::size_t at() const { return at_; }
  std::int64_t line() const { return line_; }

  /// The next token of this line; text is empty at the end of the line.
  Token token() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_]) && !is_end(text_[at_])) ++at_;
    return {text_.substr(begin, at_ - begin), begin, line_, static_cast<std::int64_t>(begin - line_begin_) + 1};
  }

  /// As token(), but each of `marks` is a token of its own, with blanks around it or not.
  Token word(std::string_view marks) {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    const std::size_t begin = at_;
    const auto marked = [&](std::size_t i) { return marks.find(text_[i]) != std::string_view::npos; };
    while (at_ < text_.size() && !is_blank(text_[at_]) && !is_end(text_[at_]) && !marked(at_)) ++at_;
    if (at_ == begin && at_ < text_.size() && marked(at_)) ++at_;
    return {text_.substr(begin, at_ - begin), begin, line_, static_cast<std::int64_t>(begin - line_begin_) + 1};
  }

  bool at_line_end() const { return at_end() || is_end(text_[at_]); }
  /// Goes to byte `at`; within the present line, or places in messages are wrong from here on.
  void seek(std::size_t at) { at_ = at; }

  /// The rest of this line, without its end; then stands at the end of the line.
  std::string_view rest() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_end(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  /// To the first character of the next line; on the last line to its end.
  void next_line() {
    rest();
    if (at_end()) return;
    at_ += (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ? 2 : 1;
    line_begin_ = at_;
    ++line_;
  }

  /// The next token on this or a later line; text is empty at the end of the file. `comment` starts a comment to the
  /// end of the line wherever a token could begin (0: none).
  Token next(char comment = 0) {
    for (;;) {
      Token t = token();
      if (!t.text.empty() && !(comment != 0 && t.text.front() == comment)) return t;
      if (t.text.empty() && at_end()) return t;
      next_line();
    }
  }

  InputError error(const Token& at, const std::string& expected) const {
    return text_error(path_, at.line, at.column, expected, at.text.empty() ? "the end of the line" : quoted(at.text));
  }

  /// The same where `at` is empty because the text ended.
  InputError error_at_end(const Token& at, const std::string& expected) const {
    return text_error(path_, at.line, at.column, expected, "the end of the data");
  }

  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  static bool is_end(char c) { return c == '\n' || c == '\r'; }

 private:
  std::string path_;
  std::string_view text_;
  std::size_t at_, line_begin_;
  std::int64_t line_;
};

/// The whole of `text` as a number: decimal, with an optional '+'; "nan", "inf", "infinity" in any case. Independent of
/// the locale. False where it is anything else or out of range (a double too small is zero or subnormal, not an error).
bool parse(std::string_view text, double& out);
bool parse(std::string_view text, float& out);
bool parse(std::string_view text, std::int64_t& out);

/// The shortest decimal that reads back as the same double, or the same float.
std::string shortest(double x);
std::string shortest(float x);

}  // namespace sinew::io
