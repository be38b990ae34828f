#include "engine/io/text.h"

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

template <class T>
bool parse_real(std::string_view text, T& out) {
  const std::string_view digits = without_plus(text);
  const char* const end = digits.data() + digits.size();
  const auto [at, error] = std::from_chars(digits.data(), end, out);
  if (at != end || digits.empty()) return false;
  if (error == std::errc{}) return true;
  if (error != std::errc::result_out_of_range) return false;
  // from_chars does not say whether the number was too large or too small: the sign of the decimal exponent does.
  const std::size_t e = digits.find_first_of("eE");
  const bool tiny = e != std::string_view::npos
                        ? digits.substr(e + 1).starts_with('-')
                        : digits.starts_with("0.") || digits.starts_with("-0.") || digits.starts_with('.');
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
