#pragma once
/// A file that several processes, on one machine or many, write at once, each its own bytes: whoever comes first makes
/// it, in its full size and with its header, which is the same for all. A process that is run again writes the same
/// bytes again. The file is complete once each of them has committed; it cannot tell that by itself.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace sinew::io {

class SharedFile {
 public:
  /// `header` are the first bytes of the file, not all zero. Throws InputError where there is what is no file on a
  /// disk, or a file that has another size or header and `force` is not given; with `force` it gets them, and keeps
  /// what else it has until that is written.
  SharedFile(const std::string& path, std::uint64_t size, std::span<const std::byte> header, bool force);
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;
  ~SharedFile();

  /// From any thread.
  void write_at(std::uint64_t at, std::span<const std::byte> bytes);
  /// To the disk.
  void commit();

 private:
  void make(std::uint64_t size, std::span<const std::byte> header, bool force);
  [[noreturn]] void fail(const std::string& expected) const;

  std::string path_;
  int file_ = -1;
};

/// Writes at byte `at` of an open file; false with errno where that fails.
bool write_all_at(int file, std::uint64_t at, std::span<const std::byte> bytes);

}  // namespace sinew::io
