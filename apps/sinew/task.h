#pragma once
/// --task I/N of a command that does its share of a larger work, and other counts on the command line.

#include <cstdint>
#include <optional>
#include <string>

#include "engine/io/share.h"

namespace sinew::app {

constexpr std::uint64_t most_tasks = 1'000'000;

/// A whole number from 1 to `most` in digits; nothing where the text is none.
std::optional<std::uint64_t> parse_number(const std::string& text, std::uint64_t most);

/// "I/N" with 1 <= I <= N. Throws UsageError.
io::Share parse_task(const std::string& text);

}  // namespace sinew::app
