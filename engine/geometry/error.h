#pragma once
/// InputError: bad input or environment. The message is one sentence that names the place, what was expected and what
/// was found; `catch` stands only in the command runner, the solver thread and main().

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace sinew {

class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// "PATH:LINE:COL: expected EXPECTED, found FOUND" (text files; line and column count from 1; column 0 is left out).
InputError text_error(const std::string& path, std::int64_t line, std::int64_t column, const std::string& expected,
                      const std::string& found);

/// "PATH: byte N: expected EXPECTED, found FOUND" (binary files; N counts from 0).
InputError byte_error(const std::string& path, std::int64_t byte, const std::string& expected,
                      const std::string& found);

/// "PATH: expected EXPECTED, found FOUND" (the whole file, a missing file, the environment).
InputError file_error(const std::string& path, const std::string& expected, const std::string& found);

/// Text of a foreign file made safe and short enough to stand in a message: quoted, control bytes as \xNN, cut at 40.
std::string quoted(std::string_view text);

}  // namespace sinew
