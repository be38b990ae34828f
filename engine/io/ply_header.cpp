#include "engine/io/ply_header.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>

#include "engine/io/text.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

/// The format's two names of each type.
constexpr std::array<std::pair<std::string_view, Type>, 16> type_names{{{"char", Type::Int8},
                                                                        {"uchar", Type::UInt8},
                                                                        {"short", Type::Int16},
                                                                        {"ushort", Type::UInt16},
                                                                        {"int", Type::Int32},
                                                                        {"uint", Type::UInt32},
                                                                        {"float", Type::Float32},
                                                                        {"double", Type::Float64},
                                                                        {"int8", Type::Int8},
                                                                        {"uint8", Type::UInt8},
                                                                        {"int16", Type::Int16},
                                                                        {"uint16", Type::UInt16},
                                                                        {"int32", Type::Int32},
                                                                        {"uint32", Type::UInt32},
                                                                        {"float32", Type::Float32},
                                                                        {"float64", Type::Float64}}};

/// Beyond any use; keeps the search for names short.
constexpr std::size_t most_properties = 4096, most_elements = 4096;

class HeaderParser {
 public:
  HeaderParser(const std::string& path, std::string_view text) : path_(path), text_(text), cursor_(path, text) {}

  PlyHeader parse() {
    magic();
    format();
    while (line()) {
    }
    end();
    check_vertices();
    return std::move(header_);
  }

 private:
  void magic() {
    const Token token = cursor_.token();
    if (token.text == "ply") return end_of_line();
    throw text_error(path_, 1, 1, "\"ply\"",
                     text_.empty() ? "an empty file" : quoted(token.text.empty() ? text_.substr(0, 8) : token.text));
  }

  void format() {
    Token token = keyword();
    while (is_comment(token)) token = keyword();
    if (token.text != "format") throw cursor_.error(token, "\"format\"");
    token = cursor_.token();
    if (token.text == "ascii") {
      header_.encoding = PlyEncoding::Ascii;
    } else if (token.text == "binary_little_endian") {
      header_.encoding = PlyEncoding::Little;
    } else if (token.text == "binary_big_endian") {
      header_.encoding = PlyEncoding::Big;
    } else {
      throw cursor_.error(token, "ascii, binary_little_endian or binary_big_endian");
    }
    token = cursor_.token();
    if (token.text != "1.0") throw cursor_.error(token, "version 1.0");
    end_of_line();
  }

  /// The first word of the next line that has one.
  Token keyword() {
    const Token token = cursor_.next();
    if (token.text.empty()) throw cursor_end(token, "\"end_header\"");
    return token;
  }

  InputError cursor_end(const Token& at, const std::string& expected) const {
    return text_error(path_, at.line, at.column, expected, "the end of the file");
  }

  bool is_comment(const Token& token) {
    if (token.text != "comment" && token.text != "obj_info") return false;
    ++header_.comments;
    cursor_.next_line();
    return true;
  }

  bool line() {
    const Token token = keyword();
    if (is_comment(token)) return true;
    if (token.text == "element") {
      element();
    } else if (token.text == "property") {
      property(token);
    } else if (token.text == "end_header") {
      return false;
    } else {
      throw cursor_.error(token, "element, property, comment, obj_info or end_header");
    }
    end_of_line();
    return true;
  }

  void element() {
    PlyElement element;
    const Token name = word("the name of an element");
    element.name = name.text;
    for (const PlyElement& other : header_.elements)
      if (other.name == element.name)
        throw text_error(path_, name.line, name.column, "each element once", "a second " + quoted(name.text));
    const Token count = cursor_.token();
    if (header_.elements.size() == most_elements) throw cursor_.error(name, "at most 4096 elements");
    std::int64_t n = 0;
    if (!io::parse(count.text, n) || n < 0) throw cursor_.error(count, "the number of " + quoted(name.text));
    element.count = static_cast<std::uint64_t>(n);
    header_.elements.push_back(std::move(element));
  }

  void property(const Token& at) {
    if (header_.elements.empty()) throw text_error(path_, at.line, at.column, "an element first", "a property");
    PlyProperty property;
    Token token = cursor_.token();
    if (token.text == "list") {
      property.list = true;
      token = cursor_.token();
      property.count_type = type(token);
      if (!is_integer(property.count_type)) throw cursor_.error(token, "an integer type for the length of a list");
      token = cursor_.token();
    }
    property.type = type(token);
    const Token name = word("the name of a property");
    property.name = name.text;
    PlyElement& element = header_.elements.back();
    for (const PlyProperty& other : element.properties)
      if (other.name == property.name)
        throw text_error(path_, name.line, name.column, "each property of " + quoted(element.name) + " once",
                         "a second " + quoted(name.text));
    if (element.properties.size() == most_properties) throw cursor_.error(name, "at most 4096 properties");
    element.properties.push_back(std::move(property));
  }

  Token word(const std::string& expected) {
    const Token token = cursor_.token();
    if (token.text.empty()) throw cursor_.error(token, expected);
    return token;
  }

  Type type(const Token& token) const {
    for (const auto& [name, type] : type_names)
      if (name == token.text) return type;
    throw cursor_.error(token, "a type (char, uchar, short, ushort, int, uint, float, double)");
  }

  void end_of_line() {
    const Token token = cursor_.token();
    if (!token.text.empty()) throw cursor_.error(token, "the end of the line");
    cursor_.next_line();
  }

  /// Stands behind end_header. Data may begin with the byte of '\n': where the first line ends in a lone '\r', so does
  /// this one.
  void end() {
    const Token token = cursor_.token();
    if (!token.text.empty()) throw cursor_.error(token, "the end of the line");
    const std::size_t first = text_.find_first_of("\r\n"), at = cursor_.at();
    const bool lone = text_[first] == '\r' && text_.substr(first + 1, 1) != "\n";
    header_.lines = cursor_.line();
    cursor_.next_line();
    header_.size = lone && at < text_.size() ? at + 1 : cursor_.at();
  }

  void check_vertices() {
    const auto& elements = header_.elements;
    const auto at = std::find_if(elements.begin(), elements.end(), [](const auto& e) { return e.name == "vertex"; });
    if (at == elements.end()) throw text_error(path_, header_.lines, 0, "an element \"vertex\" before it", "none");
    header_.vertex = static_cast<std::size_t>(at - elements.begin());
    for (const char* name : {"x", "y", "z"}) {
      const auto& properties = at->properties;
      const bool found =
          std::any_of(properties.begin(), properties.end(), [&](const auto& p) { return p.name == name && !p.list; });
      if (found) continue;
      std::string names;
      for (std::size_t i = 0; i < std::min<std::size_t>(properties.size(), 4); ++i)
        names += (i > 0 ? ", " : "") + quoted(properties[i].name);
      throw text_error(path_, header_.lines, 0, std::string("a property ") + name + " of the points",
                       properties.empty() ? "no property" : names + (properties.size() > 4 ? ", ..." : ""));
    }
  }

  const std::string& path_;
  std::string_view text_;
  TextCursor cursor_;
  PlyHeader header_;
};

}  // namespace

bool PlyElement::has_list() const {
  return std::any_of(properties.begin(), properties.end(), [](const auto& p) { return p.list; });
}

std::size_t PlyElement::row_size() const {
  std::size_t size = 0;
  for (const PlyProperty& p : properties) size += size_of(p.list ? p.count_type : p.type);
  return size;
}

bool PlyHeader::swap() const {
  return (encoding == PlyEncoding::Big) != (std::endian::native == std::endian::big);
}

PlyHeader parse_ply_header(const std::string& path, std::string_view text) {
  return HeaderParser(path, text).parse();
}

const char* ply_name_of(Type type) {
  for (const auto& [name, t] : type_names)
    if (t == type) return name.data();
  return nullptr;
}

}  // namespace sinew::io
