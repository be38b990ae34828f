#pragma once
/// A walk over the tags of an XML file that knows the byte of each, so that a writer can replace what stands between
/// two. What VTK's files use of XML: elements with attributes, comments, a declaration; no CDATA and no document type.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/geometry/error.h"

namespace sinew::io {

struct XmlTag {
  std::string_view name;               ///< empty at the end of the file
  bool opens = false, closes = false;  ///< <a>, </a>; both for <a/>
  std::size_t begin = 0, end = 0;      ///< bytes of the file, from '<' to behind '>'
  std::int64_t line = 1, column = 1;   ///< of begin
  std::vector<std::pair<std::string_view, std::string>> attributes;

  /// The value of an attribute, or `otherwise`.
  std::string value(std::string_view attribute, const std::string& otherwise = "") const;
};

class XmlScanner {
 public:
  XmlScanner(std::string path, std::string_view text) : path_(std::move(path)), text_(text) {}

  /// The next tag. Throws InputError where there is none of a form that XML has.
  XmlTag next();

  /// An error at the tag.
  InputError error(const XmlTag& at, const std::string& expected, const std::string& found) const;

 private:
  bool skip(std::string_view opening, std::string_view closing);
  void advance(std::size_t to);
  void read_attribute(XmlTag& tag, std::size_t& at) const;
  std::string unescaped(const XmlTag& tag, std::string_view text) const;

  std::string path_;
  std::string_view text_;
  std::size_t at_ = 0, line_begin_ = 0;
  std::int64_t line_ = 1;
};

}  // namespace sinew::io
