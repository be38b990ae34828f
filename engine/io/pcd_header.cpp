#include <array>
#include <optional>

#include "engine/io/bytes.h"
#include "engine/io/pcd_content.h"
#include "engine/io/text.h"

namespace sinew::io {

namespace {

constexpr std::size_t most_fields = 1024, most_values = 65536;

class HeaderParser {
 public:
  HeaderParser(std::string path, std::span<const std::byte> bytes)
      : path_(std::move(path)), cursor_(path_, as_text(bytes)), size_(bytes.size()) {}

  PcdHeader read() {
    if (size_ == 0) throw file_error(path_, "a PCD header", "an empty file");
    while (!ended_) parse_line();
    finish();
    return std::move(header_);
  }

 private:
  void parse_line() {
    if (cursor_.at_end()) throw text_error(path_, cursor_.line(), 0, "a header line with DATA", "the end of the file");
    const Token keyword = cursor_.token();
    if (keyword.text.empty() || keyword.text.front() == '#' || keyword.text == "VERSION" ||
        keyword.text == "VIEWPOINT") {
    } else if (keyword.text == "FIELDS" || keyword.text == "COLUMNS") {
      parse_names(keyword);
    } else if (keyword.text == "SIZE") {
      each_field(keyword,
                 [&](PcdField&, const Token& t, std::size_t f) { sizes_[f] = number(t, "a size of 1, 2, 4 or 8", 8); });
      size_token_ = keyword;
    } else if (keyword.text == "TYPE") {
      each_field(keyword, [&](PcdField&, const Token& t, std::size_t f) {
        if (t.text != "I" && t.text != "U" && t.text != "F") throw cursor_.error(t, "a type of I, U or F");
        types_[f] = t.text[0];
      });
      size_token_ = keyword;
    } else if (keyword.text == "COUNT") {
      each_field(keyword, [&](PcdField& field, const Token& t, std::size_t) {
        field.count = number(t, "a count of 1 to 65536", most_values);
        if (field.count == 0) throw cursor_.error(t, "a count of 1 to 65536");
      });
    } else if (keyword.text == "WIDTH") {
      width_ = parse_count("the width");
    } else if (keyword.text == "HEIGHT") {
      height_ = parse_count("the height");
    } else if (keyword.text == "POINTS") {
      points_token_ = keyword;
      points_ = parse_count("the count of points");
    } else if (keyword.text == "DATA") {
      parse_data(keyword);
    } else {
      throw cursor_.error(keyword, "a keyword of a PCD header");
    }
    cursor_.next_line();
  }

  void parse_names(const Token& keyword) {
    if (!header_.fields.empty()) throw cursor_.error(keyword, "one line of FIELDS");
    for (Token t = cursor_.token(); !t.text.empty(); t = cursor_.token()) {
      if (header_.fields.size() == most_fields) throw cursor_.error(t, "at most 1024 fields");
      header_.fields.push_back({std::string(t.text)});
    }
    sizes_.assign(header_.fields.size(), 4);
    types_.assign(header_.fields.size(), 'F');
  }

  template <class F>
  void each_field(const Token& keyword, F&& f) {
    if (header_.fields.empty()) throw cursor_.error(keyword, "FIELDS before it");
    const std::string expected = "a value for each of the " + std::to_string(header_.fields.size()) + " fields";
    for (std::size_t i = 0; i < header_.fields.size(); ++i) {
      const Token t = cursor_.token();
      if (t.text.empty()) throw cursor_.error(t, expected);
      f(header_.fields[i], t, i);
    }
    const Token more = cursor_.token();
    if (!more.text.empty()) throw cursor_.error(more, expected);
  }

  std::size_t number(const Token& t, const std::string& expected, std::size_t most) const {
    std::int64_t x = 0;
    if (!parse(t.text, x) || x < 0 || static_cast<std::size_t>(x) > most) throw cursor_.error(t, expected);
    return static_cast<std::size_t>(x);
  }

  std::size_t parse_count(const std::string& what) {
    return number(cursor_.token(), what + " (0 to 4294967294)", 0xfffffffe);
  }

  void parse_data(const Token& keyword) {
    const Token t = cursor_.token();
    if (header_.fields.empty()) throw cursor_.error(keyword, "FIELDS before it");
    if (t.text == "ascii") {
      header_.data = PcdHeader::Data::Ascii;
    } else if (t.text == "binary") {
      header_.data = PcdHeader::Data::Binary;
    } else if (t.text == "binary_compressed") {
      header_.data = PcdHeader::Data::Compressed;
    } else {
      throw cursor_.error(t, "ascii, binary or binary_compressed");
    }
    ended_ = true;
  }

  static std::optional<Type> type_of(char type, std::size_t size) {
    static constexpr std::array<Type, 4> ints = {Type::Int8, Type::Int16, Type::Int32, Type::Int64};
    static constexpr std::array<Type, 4> uints = {Type::UInt8, Type::UInt16, Type::UInt32, Type::UInt64};
    if (!std::has_single_bit(size) || (type == 'F' && size < 4)) return std::nullopt;
    const auto log = static_cast<std::size_t>(std::countr_zero(size));
    if (type == 'F') return size == 4 ? Type::Float32 : Type::Float64;
    return type == 'I' ? ints[log] : uints[log];
  }

  void finish() {
    for (std::size_t f = 0; f < header_.fields.size(); ++f) {
      PcdField& field = header_.fields[f];
      const auto type = type_of(types_[f], sizes_[f]);
      if (!type)
        throw text_error(
            path_, size_token_.line, 0, "a TYPE I or U of SIZE 1, 2, 4 or 8, or F of 4 or 8",
            std::string(1, types_[f]) + " of " + std::to_string(sizes_[f]) + " for field " + quoted(field.name));
      field.type = *type;
      field.offset = header_.point_size;
      header_.point_size += field.size();
      header_.values += field.count;
    }
    if (header_.values > most_values)
      throw file_error(path_, "at most 65536 values a point", std::to_string(header_.values));
    header_.begin = cursor_.at();
    header_.line = cursor_.line();
    check_points();
  }

  void check_points() {
    if (!width_ && !points_) throw file_error(path_, "a header with WIDTH or POINTS", "neither");
    // Both are below 2^32, so that the product is exact.
    const std::uint64_t product = width_ ? static_cast<std::uint64_t>(*width_) * height_.value_or(1) : *points_;
    if (points_ && product != *points_)
      throw text_error(path_, points_token_.line, 0, "POINTS as WIDTH x HEIGHT (" + std::to_string(product) + ")",
                       std::to_string(*points_));
    if (product >= 0xffffffff) throw file_error(path_, "fewer than 2^32 - 1 points", std::to_string(product));
    header_.points = static_cast<std::size_t>(product);
    const std::size_t left = size_ - header_.begin;
    // Packed data is checked by its own sizes; text has at least a digit and a blank for each value.
    const std::size_t smallest = header_.data == PcdHeader::Data::Ascii ? 2 * header_.values : header_.point_size;
    if (header_.data != PcdHeader::Data::Compressed && header_.points > (left + 1) / smallest)
      throw byte_error(path_, static_cast<std::int64_t>(header_.begin),
                       std::to_string(header_.points) + " points of at least " + std::to_string(smallest) + " bytes",
                       "only " + std::to_string(left) + " bytes to the end of the file");
    if (header_.data == PcdHeader::Data::Binary && left < header_.points * header_.point_size)
      throw byte_error(path_, static_cast<std::int64_t>(header_.begin),
                       std::to_string(header_.points * header_.point_size) + " bytes of points",
                       "only " + std::to_string(left) + " bytes to the end of the file");
  }

  std::string path_;
  TextCursor cursor_;
  std::size_t size_;
  PcdHeader header_;
  bool ended_ = false;
  std::vector<std::size_t> sizes_;
  std::vector<char> types_;
  Token size_token_, points_token_;
  std::optional<std::size_t> width_, height_, points_;
};

}  // namespace

PcdHeader parse_pcd_header(const std::string& path, std::span<const std::byte> bytes) {
  return HeaderParser(path, bytes).read();
}

}  // namespace sinew::io
