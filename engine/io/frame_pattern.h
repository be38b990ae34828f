#pragma once
/// Frame numbers as text, and file names with a place for one, by the grammar of Fileseq.
///
/// Frames: parts with commas between, each `A`, `A-B` (also descending), `A-BxN` (every Nth from A), `A-ByN` (all that
/// xN leaves out) or `A-B:N` (xN, then x(N-1) ... x1); numbers may be negative: "1-10", "-5-10x5", "1,20,30-40x5".
///
/// Names: `name.####.ext`, `name.@@@.ext`, `name.%04d.ext`; the place stands in the last part of the path. A single `#`
/// is four digits and each `@` one, as in Fileseq; of two and more `#` each is one digit, as in most other programs
/// (Fileseq: four). Frames may stand before it, after a dot, an underscore or at the beginning: `name.1-10#.ext`. A
/// number has at least as many digits as its place, a minus counted with them, and zeros in front up to that.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sinew::io {

/// The frames of a text, each once, in the text's order, at most a million. Throws InputError that begins with `place`.
std::vector<int> parse_frames(const std::string& place, std::string_view text);

/// Ascending frames as a short text that parse_frames reads: "1-10,14,20-30x2".
std::string frames_text(std::span<const int> frames);

struct FramePattern {
  std::string text;           ///< as it was given
  std::string before, after;  ///< the path but for the number
  std::size_t width = 1;      ///< digits at least
  std::vector<int> frames;    ///< that stand in the name, ascending; empty where none do

  std::string path(int frame) const;
  /// The frame whose file has this name (the last part of a path).
  std::optional<int> frame_of(std::string_view name) const;
};

/// The pattern of a path; nothing where it has no place for a frame or where a file has this very name. Throws
/// InputError: two places, wrong frames.
std::optional<FramePattern> frame_pattern(const std::string& path);

/// The frames whose files are there, ascending. Throws InputError where the folder cannot be read.
std::vector<int> frames_on_disk(const FramePattern& pattern);

}  // namespace sinew::io
