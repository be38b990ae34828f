#include "engine/io/text.h"

#include <algorithm>
#include <cmath>
#include <system_error>

namespace sinew::io {

namespace {

std::string_view without_plus(std::string_view text) {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+';
  return plus ? text.substr(1) : text;
}

template <class T>
std::string to_text(T x) {
  char buffer[64];
  const auto result = std::to_chars(buffer, buffer + sizeof(buffer), x);
  return {buffer, result.ptr};
}

/// e where the first digit that is not zero stands for d * 10^e. The text is a number that from_chars took.
std::int64_t first_digit_exponent(std::string_view digits) {
  const std::size_t e = std::min(digits.find_first_of("eE"), digits.size());
  std::int64_t exponent = 0;
  if (e < digits.size()) {
    const std::string_view text = without_plus(digits.substr(e + 1));
    const auto [at, error] = std::from_chars(text.data(), text.data() + text.size(), exponent);
    // Beyond any shift that the digits could make up for.
    if (error == std::errc::result_out_of_range) return text.starts_with('-') ? -1 : 1;
  }
  const std::string_view mantissa = digits.substr(0, e);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t first = std::min(mantissa.find_first_of("123456789"), mantissa.size());
  const auto shift = static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first);
  return exponent + (first < point ? shift - 1 : shift);
}

template <class T>
bool parse_real(std::string_view text, T& out) {
  const std::string_view digits = without_plus(text);
  const char* const end = digits.data() + digits.size();
  const auto [at, error] = std::from_chars(digits.data(), end, out);
  if (at != end || digits.empty()) return false;
  if (error == std::errc{}) return true;
  if (error != std::errc::result_out_of_range) return false;
  const bool tiny = first_digit_exponent(digits) < 0;  // from_chars does not say whether too large or too small
  if (tiny) out = digits.starts_with('-') ? T{-0.0F} : T{0};
  return tiny;
}

}  // namespace

bool parse(std::string_view text, double& out) {
  return parse_real(text, out);
}

bool parse(std::string_view text, float& out) {
  return parse_real(text, out);
}

bool parse(std::string_view text, std::int64_t& out) {
  const std::string_view digits = without_plus(text);
  const auto [at, error] = std::from_chars(digits.data(), digits.data() + digits.size(), out);
  return error == std::errc{} && at == digits.data() + digits.size() && !digits.empty();
}

std::string shortest(double x) {
  return to_text(x);
}
std::string shortest(float x) {
  return to_text(x);
}

}  // namespace sinew::io
