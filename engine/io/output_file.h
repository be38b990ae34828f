#pragma once
/// A file that is written whole or not at all: a temporary file beside it until commit(). "-" is standard output;
/// devices and pipes are written as they come.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace sinew::io {

/// Throws InputError where `path` exists and `force` is not given (devices, pipes and "-" are never refused).
void refuse_existing(const std::string& path, bool force);

class OutputFile {
 public:
  OutputFile(const std::string& path, bool force);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();  ///< without commit() nothing is left

  void write(std::span<const std::byte> bytes);
  /// At byte `at`, from any thread; not on pipes. What lies between is zero.
  void write_at(std::uint64_t at, std::span<const std::byte> bytes);
  /// To the disk and under its name, with its folder.
  void commit();

 private:
  [[noreturn]] void fail(const std::string& expected) const;

  std::string path_, target_, temporary_;  ///< target_: what path_ leads to; temporary_ is empty where there is none
  int file_ = -1;
  bool force_;
};

}  // namespace sinew::io
