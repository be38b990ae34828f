#include "engine/io/ply_values.h"

#include <cmath>

namespace sinew::io {

namespace {

std::string range_of(Type type) {
  return with_type(type, [](auto t) -> std::string {
    using T = decltype(t);
    if constexpr (std::is_integral_v<T>) {
      return "a whole number from " + std::to_string(std::numeric_limits<T>::lowest()) + " to " +
             std::to_string(std::numeric_limits<T>::max());
    } else {
      return "a number";
    }
  });
}

std::string rows_of(const PlyElement& element) {
  return std::to_string(element.count) + " rows of " + quoted(element.name);
}

}  // namespace

std::string PlyPlace::name() const {
  return property->name + " of " + element->name + " " + std::to_string(row);
}

void PlyBinary::begin_element(const PlyElement& element) {
  place_.element = &element;
  ByteCursor(path_, bytes_, at_).check_count(element.count, element.row_size(), "rows of " + quoted(element.name));
}

std::int64_t PlyBinary::whole(double x) const {
  constexpr double largest = 1e15;
  if (std::abs(x) <= largest && x == std::floor(x)) return static_cast<std::int64_t>(x);
  throw error("a whole number as " + place_.name(), shortest(x));
}

InputError PlyBinary::error(const std::string& expected, const std::string& found) const {
  return byte_error(path_, static_cast<std::int64_t>(last_), expected, found);
}

InputError PlyBinary::truncated(std::size_t size, std::uint64_t count) const {
  const std::string values = count == 1 ? "" : std::to_string(count) + " values of ";
  return byte_error(path_, static_cast<std::int64_t>(at_),
                    values + place_.name() + " (" + std::to_string(size) + (size == 1 ? " byte" : " bytes") +
                        (count == 1 ? ")" : " each)"),
                    "the end of the file after " + std::to_string(bytes_.size() - at_));
}

void PlyText::begin_element(const PlyElement& element) {
  place_.element = &element;
  // A value takes at least one character and one behind it, but for the last of the file.
  const std::size_t smallest = 2 * element.properties.size(), left = text_.size() - cursor_.at();
  if (smallest > 0 && element.count > (left + 1) / smallest)
    throw text_error(path_, cursor_.line(), 0, rows_of(element),
                     "only " + std::to_string(left) + " bytes to the end of the file");
}

InputError PlyText::error(const std::string& expected, const std::string& found) const {
  return text_error(path_, last_.line, last_.column, expected, found);
}

InputError PlyText::missing(Type type) const {
  return error(place_.name() + ", " + range_of(type), cursor_.at_end() ? "the end of the file" : "the end of the line");
}

std::int64_t PlyText::integer(Type type) {
  const Token& token = take(type);
  std::int64_t x = 0;
  if (!is_integer(type)) {
    double real = 0;
    constexpr double largest = 1e15;
    if (!parse(token.text, real) || !(std::abs(real) <= largest) || real != std::floor(real))
      throw error(place_.name() + ", a whole number", quoted(token.text));
    return static_cast<std::int64_t>(real);
  }
  const bool fits = parse(token.text, x) && with_type(type, [x](auto t) {
                      using Limits = std::numeric_limits<decltype(t)>;
                      return static_cast<double>(x) >= static_cast<double>(Limits::lowest()) &&
                             static_cast<double>(x) <= static_cast<double>(Limits::max());
                    });
  if (!fits) throw error(place_.name() + ", " + range_of(type), quoted(token.text));
  return x;
}

void PlyText::value(Type type, std::byte* out) {
  if (is_integer(type)) {
    const std::int64_t x = integer(type);
    with_type(type, [x, out](auto t) { store(out, static_cast<decltype(t)>(x), false); });
    return;
  }
  const Token& token = take(type);
  float narrow = 0;
  double wide = 0;
  const bool good = type == Type::Float32 ? parse(token.text, narrow) : parse(token.text, wide);
  if (!good) throw error(place_.name() + ", " + range_of(type), quoted(token.text));
  if (type == Type::Float32) {
    store(out, narrow, false);
  } else {
    store(out, wide, false);
  }
}

void PlyText::skip(Type type, std::uint64_t count) {
  std::byte value[8];
  for (std::uint64_t i = 0; i < count; ++i) this->value(type, value);
}

}  // namespace sinew::io
