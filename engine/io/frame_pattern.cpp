#include "engine/io/frame_pattern.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <unordered_set>

#include "engine/geometry/error.h"

namespace sinew::io {

namespace {

constexpr std::size_t most_frames = 1'000'000;
constexpr int largest = 999'999'999;  ///< of a number: sums of two fit an int

/// A walk over one part of a text of frames.
class Part {
 public:
  Part(const std::string& place, std::string_view text) : place_(place), text_(text), left_(text) {}

  bool done() const { return left_.empty(); }
  bool take(char c) {
    if (left_.empty() || left_.front() != c) return false;
    left_.remove_prefix(1);
    return true;
  }
  int number() {
    int x = 0;
    const auto [end, error] = std::from_chars(left_.data(), left_.data() + left_.size(), x);
    if (error == std::errc::invalid_argument) throw wrong("a frame number");
    if (error != std::errc{} || x > largest || x < -largest) throw wrong("a frame of at most nine digits");
    left_.remove_prefix(static_cast<std::size_t>(end - left_.data()));
    return x;
  }
  InputError wrong(const std::string& expected) const {
    return file_error(place_, expected + " (frames are like 1-10x2,15)", "in " + sinew::quoted(text_) + " " + found());
  }

 private:
  std::string found() const { return left_.empty() ? "nothing more" : sinew::quoted(left_); }

  const std::string& place_;
  std::string_view text_, left_;
};

/// Frames in the order in which they came, each once.
class FrameSet {
 public:
  explicit FrameSet(const std::string& place) : place_(place) {}

  void add(int frame) {
    if (!known_.insert(frame).second) return;
    if (frames.size() == most_frames)
      throw file_error(place_, "at most " + std::to_string(most_frames) + " frames", "more");
    frames.push_back(frame);
  }
  /// Every step-th of a..b; or, `others`, all but those.
  void add(int a, int b, int step, bool others) {
    const std::int64_t count = std::abs(std::int64_t{b} - a) + 1;
    if (count / (others ? 1 : step) > static_cast<std::int64_t>(most_frames))
      throw file_error(place_, "at most " + std::to_string(most_frames) + " frames", std::to_string(count));
    for (std::int64_t i = 0; i < count; i += others ? 1 : step)
      if (!others || i % step != 0) add(static_cast<int>(a <= b ? a + i : a - i));
  }

  std::vector<int> frames;

 private:
  const std::string& place_;
  std::unordered_set<int> known_;
};

void add_part(const std::string& place, std::string_view text, FrameSet& set) {
  Part part(place, text);
  const int a = part.number();
  if (part.done()) return set.add(a);
  if (!part.take('-')) throw part.wrong("- or a comma after a frame");
  const int b = part.number();
  if (part.done()) return set.add(a, b, 1, false);
  const char how = part.take('x') ? 'x' : part.take('y') ? 'y' : part.take(':') ? ':' : '\0';
  if (how == '\0') throw part.wrong("x, y or : and a step after a range");
  const int step = part.number();
  if (step < 1) throw part.wrong("a step of 1 or more");
  if (!part.done()) throw part.wrong("a comma after a range");
  set.add(a, b, step, how == 'y');
  // Beyond the length of the range each step gives its first frame alone.
  const auto length = static_cast<int>(std::min<std::int64_t>(std::abs(std::int64_t{b} - a) + 1, largest));
  for (int s = std::min(step, length); how == ':' && s > 1;) set.add(a, b, --s, false);
}

bool is_frame_text(char c) {
  return (c >= '0' && c <= '9') || c == '-' || c == ',' || c == 'x' || c == 'y' || c == ':';
}

/// Where a place for a frame stands in a name.
struct Place {
  std::size_t begin = 0, end = 0, width = 0;
};

/// The place that begins at `at`; width 0 where none does.
Place place_at(std::string_view name, std::size_t at) {
  const char c = name[at];
  std::size_t end = at;
  if (c == '#' || c == '@') {
    while (end < name.size() && (name[end] == '#' || name[end] == '@')) ++end;
    const std::string_view run = name.substr(at, end - at);
    return {at, end, run == "#" ? 4 : run.size()};
  }
  if (c != '%') return {};
  end = name.find_first_not_of("0123456789", at + 1);
  if (end == std::string_view::npos || name[end] != 'd') return {};
  std::size_t width = 1;
  if (const std::string_view digits = name.substr(at + 1, end - at - 1); !digits.empty()) {
    const auto [last, error] = std::from_chars(digits.data(), digits.data() + digits.size(), width);
    if (digits.front() != '0' || error != std::errc{} || width < 1 || width > 20) return {};
  }
  return {at, end + 1, width};
}

std::string padded(int frame, std::size_t width) {
  std::string digits = std::to_string(std::abs(frame));
  const std::size_t sign = frame < 0 ? 1 : 0;
  if (digits.size() + sign < width) digits.insert(0, width - sign - digits.size(), '0');
  return (frame < 0 ? "-" : "") + digits;
}

}  // namespace

std::vector<int> parse_frames(const std::string& place, std::string_view text) {
  std::string plain(text);
  std::erase(plain, ' ');
  if (plain.empty()) throw file_error(place, "frames, like 1-10x2,15", "none");
  FrameSet set(place);
  for (std::size_t begin = 0; begin <= plain.size();) {
    const std::size_t end = std::min(plain.find(',', begin), plain.size());
    add_part(place, std::string_view(plain).substr(begin, end - begin), set);
    begin = end + 1;
  }
  if (set.frames.empty()) throw file_error(place, "at least one frame", "none in " + sinew::quoted(plain));
  return std::move(set.frames);
}

std::string frames_text(std::span<const int> frames) {
  std::string text;
  for (std::size_t i = 0; i < frames.size();) {
    if (!text.empty()) text += ',';
    text += std::to_string(frames[i]);
    std::size_t last = i;
    const int step = i + 1 < frames.size() ? frames[i + 1] - frames[i] : 1;
    while (last + 1 < frames.size() && frames[last + 1] - frames[last] == step) ++last;
    // Two frames are a range only where nothing lies between them.
    if (last == i + 1 && step != 1) last = i;
    if (last > i) text += "-" + std::to_string(frames[last]);
    if (last > i && step != 1) text += "x" + std::to_string(step);
    i = last + 1;
  }
  return text;
}

std::string FramePattern::path(int frame) const {
  return before + padded(frame, width) + after;
}

std::optional<int> FramePattern::frame_of(std::string_view name) const {
  const std::string_view head = std::string_view(before).substr(before.find_last_of('/') + 1);
  if (name.size() <= head.size() + after.size() || !name.starts_with(head) || !name.ends_with(after)) return {};
  const std::string_view digits = name.substr(head.size(), name.size() - head.size() - after.size());
  int frame = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), frame);
  if (error != std::errc{} || std::abs(std::int64_t{frame}) > largest || padded(frame, width) != digits) return {};
  return frame;
}

std::optional<FramePattern> frame_pattern(const std::string& path) {
  const std::size_t name_begin = path.find_last_of('/') + 1;
  const std::string_view name = std::string_view(path).substr(name_begin);
  Place place;
  for (std::size_t at = 0; at < name.size(); ++at) {
    const Place next = place_at(name, at);
    if (next.width == 0) continue;
    if (place.width > 0)
      throw file_error(path, "one place for the frame (#, @ or %04d)",
                       sinew::quoted(name.substr(place.begin, place.end - place.begin)) + " and " +
                           sinew::quoted(name.substr(next.begin, next.end - next.begin)));
    place = next;
    at = next.end - 1;
  }
  std::error_code none;
  if (place.width == 0 || std::filesystem::exists(path, none)) return {};
  FramePattern pattern;
  pattern.text = path;
  pattern.width = place.width;
  pattern.after = name.substr(place.end);
  std::size_t begin = place.begin;
  while (begin > 0 && is_frame_text(name[begin - 1])) --begin;
  const bool separate = begin == 0 || name[begin - 1] == '.' || name[begin - 1] == '_';
  if (begin < place.begin && separate) {
    pattern.frames = parse_frames(path, name.substr(begin, place.begin - begin));
    std::sort(pattern.frames.begin(), pattern.frames.end());
    place.begin = begin;
  }
  pattern.before = path.substr(0, name_begin + place.begin);
  return pattern;
}

std::vector<int> frames_on_disk(const FramePattern& pattern) {
  const std::filesystem::path folder = std::filesystem::path(pattern.before + "x").parent_path();
  std::error_code error;
  std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, error);
  std::vector<int> frames;
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error))
    if (const std::optional<int> frame = pattern.frame_of(entry->path().filename().native())) frames.push_back(*frame);
  if (error) throw file_error(pattern.text, "a folder that can be read", sinew::quoted(error.message()));
  std::sort(frames.begin(), frames.end());
  return frames;
}

}  // namespace sinew::io
