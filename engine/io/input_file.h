#pragma once
/// A file that is read from its beginning, or on a disk from any place, to its end; "-" is standard input.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace sinew::io {

class InputFile {
 public:
  /// Throws InputError: missing, a folder, not readable.
  explicit InputFile(const std::string& path);
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();

  /// Fills `bytes`; fewer than asked for only at the end of the file. Returns how many.
  std::size_t read(std::span<std::byte> bytes);
  /// Goes on reading at byte `at`; only for a file that has a size.
  void seek(std::uint64_t at);
  /// Of a file on a disk; pipes and devices have none.
  std::optional<std::uint64_t> size() const { return size_; }

 private:
  std::string path_;
  int file_ = -1;
  std::optional<std::uint64_t> size_;
};

}  // namespace sinew::io
