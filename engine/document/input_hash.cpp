#include "engine/document/input_hash.h"

#include <algorithm>
#include <filesystem>

#include "engine/io/frame_pattern.h"
#include "engine/io/sha256.h"

namespace sinew::document {

namespace {

const std::string prefix = "sha256:";

}  // namespace

std::string input_hash(const std::string& path, const std::function<bool()>& go_on) {
  const std::optional<io::FramePattern> pattern = io::frame_pattern(path);
  std::string hash;
  if (pattern) {
    std::string lines;
    for (const int frame : io::frames_on_disk(*pattern)) {
      const std::string file = pattern->path(frame), of_frame = io::sha256_of_file(file, go_on);
      if (of_frame.empty()) return {};
      lines += of_frame + "  " + std::filesystem::path(file).filename().string() + "\n";
    }
    hash = io::hexadecimal(io::sha256(std::as_bytes(std::span(lines))));
  } else {
    hash = io::sha256_of_file(path, go_on);
  }
  return hash.empty() ? hash : prefix + hash;
}

bool is_input_hash(const std::string& text) {
  return text.size() == prefix.size() + 64 && text.starts_with(prefix) &&
         std::all_of(text.begin() + static_cast<std::ptrdiff_t>(prefix.size()), text.end(),
                     [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

std::string sentence_of_other_input(const std::string& input) {
  return input + " is not the file that this edit was saved with (another SHA-256): points may have other numbers.";
}

}  // namespace sinew::document
