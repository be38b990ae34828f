#pragma once
/// The data of a PLY file, value after value, with the same face for ascii and binary. Every value knows its place
/// (element, row, property), so that errors can name it.

#include <algorithm>
#include <cstdint>
#include <string>

#include "engine/io/bytes.h"
#include "engine/io/ply_header.h"
#include "engine/io/text.h"
#include "engine/io/values.h"

namespace sinew::io {

/// Where a walk over the data is, for messages.
struct PlyPlace {
  const PlyElement* element = nullptr;
  std::uint64_t row = 0;
  const PlyProperty* property = nullptr;

  std::string name() const;  ///< "x of vertex 7", rows counted from 0
};

/// Values of a binary file.
class PlyBinary {
 public:
  PlyBinary(const std::string& path, std::span<const std::byte> bytes, std::size_t at, bool swap)
      : path_(path), bytes_(bytes), at_(at), swap_(swap) {}

  /// Believes the element's count only where so many rows fit into the bytes left.
  void begin_element(const PlyElement& element);
  void begin_row(std::uint64_t row) { place_.row = row; }
  void end_row() {}
  void set_property(const PlyProperty& property) { place_.property = &property; }

  std::int64_t integer(Type type) {
    const std::byte* at = take(size_of(type), 1);
    return with_type(type, [&](auto t) -> std::int64_t {
      const auto x = load<decltype(t)>(at, swap_);
      if constexpr (std::is_integral_v<decltype(t)>) {
        return static_cast<std::int64_t>(x);
      } else {
        return whole(static_cast<double>(x));
      }
    });
  }
  /// Stores the value, in this machine's byte order, at `out`.
  void value(Type type, std::byte* out) {
    const std::size_t size = size_of(type);
    std::memcpy(out, take(size, 1), size);
    if (swap_) std::reverse(out, out + size);
  }
  void skip(Type type, std::uint64_t count) { take(size_of(type), count); }
  void skip_rows(std::uint64_t rows, std::size_t size) { take(size, rows); }

  /// At the value read last.
  InputError error(const std::string& expected, const std::string& found) const;
  const PlyPlace& place() const { return place_; }
  std::size_t at() const { return at_; }
  std::size_t last() const { return last_; }  ///< where the value read last begins
  std::size_t size_of_last() const { return at_ - last_; }

 private:
  const std::byte* take(std::size_t size, std::uint64_t count) {
    if (count > (bytes_.size() - at_) / size) throw truncated(size, count);
    last_ = at_;
    at_ += size * count;
    return bytes_.data() + last_;
  }
  std::int64_t whole(double x) const;
  InputError truncated(std::size_t size, std::uint64_t count) const;

  std::string path_;
  std::span<const std::byte> bytes_;
  std::size_t at_, last_ = 0;
  PlyPlace place_;
  bool swap_;
};

/// Values of an ascii file: a row is a line; empty lines are passed over.
class PlyText {
 public:
  PlyText(const std::string& path, std::string_view text, std::size_t at, std::int64_t line)
      : path_(path), text_(text), cursor_(path, text, at, line) {}

  void begin_element(const PlyElement& element);
  void begin_row(std::uint64_t row) {
    place_.row = row;
    first_ = true;
  }
  void end_row() {
    if (first_) return;  // a row without values has no line
    last_ = cursor_.token();
    if (!last_.text.empty()) throw error("the end of the line after " + place_.name(), quoted(last_.text));
    cursor_.next_line();
  }
  void set_property(const PlyProperty& property) { place_.property = &property; }

  std::int64_t integer(Type type);
  void value(Type type, std::byte* out);
  void skip(Type type, std::uint64_t count);

  InputError error(const std::string& expected, const std::string& found) const;
  const PlyPlace& place() const { return place_; }
  std::size_t at() const { return cursor_.at(); }
  std::int64_t line() const { return cursor_.line(); }
  std::size_t last() const { return last_.begin; }
  std::size_t size_of_last() const { return last_.text.size(); }

 private:
  const Token& take(Type type) {
    last_ = first_ ? cursor_.next() : cursor_.token();
    first_ = false;
    if (last_.text.empty()) throw missing(type);
    return last_;
  }
  InputError missing(Type type) const;

  std::string path_;
  std::string_view text_;
  TextCursor cursor_;
  Token last_;
  PlyPlace place_;
  bool first_ = true;
};

/// The length of a list that begins here.
template <class Values>
std::uint64_t list_length(Values& values, const PlyProperty& property) {
  values.set_property(property);
  const std::int64_t n = values.integer(property.count_type);
  if (n < 0) throw values.error("the length of " + values.place().name(), std::to_string(n));
  return static_cast<std::uint64_t>(n);
}

/// Reads one row into `packed`: scalars one after the other, of a list only its length, all in this machine's byte
/// order. Calls each(i, begin, size) with the place in the file of the value of property i, unless it is a list.
template <class Values, class Each>
void read_packed(Values& values, const PlyElement& element, std::byte* packed, const Each& each) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (property.list) {
      const std::uint64_t n = list_length(values, property);
      packed += size_of(property.count_type);
      values.skip(property.type, n);
    } else {
      values.set_property(property);
      values.value(property.type, packed);
      packed += size_of(property.type);
      each(i, values.last(), values.size_of_last());
    }
  }
}

}  // namespace sinew::io
