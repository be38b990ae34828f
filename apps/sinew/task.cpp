#include "apps/sinew/task.h"

#include <charconv>

#include "apps/sinew/command.h"
#include "engine/geometry/error.h"

namespace sinew::app {

std::optional<std::uint64_t> parse_number(const std::string& text, std::uint64_t most) {
  std::uint64_t number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end || number < 1 || number > most) return std::nullopt;
  return number;
}

io::Share parse_task(const std::string& text) {
  const std::size_t slash = text.find('/');
  const auto index = parse_number(text.substr(0, slash), most_tasks);
  const auto count = slash == std::string::npos ? std::nullopt : parse_number(text.substr(slash + 1), most_tasks);
  if (!index || !count || *index > *count)
    throw UsageError("--task: expected I/N, 1 <= I <= N <= " + std::to_string(most_tasks) + ", found " +
                     sinew::quoted(text));
  return {*index, *count};
}

}  // namespace sinew::app
