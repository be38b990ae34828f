#pragma once
/// ByteSource: the bytes of a file from which parts are read at any place and from any thread, so that a frame of a
/// long file costs that frame.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace sinew::io {

class ByteSource {
 public:
  virtual ~ByteSource() = default;
  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }

  /// Fills `bytes` from byte `at` on. Throws InputError where the file has become shorter or cannot be read.
  virtual void read(std::uint64_t at, std::span<std::byte> bytes) const = 0;
  /// `count` bytes from `at` on.
  std::vector<std::byte> read(std::uint64_t at, std::size_t count) const;

 protected:
  ByteSource(std::string path, std::uint64_t size) : path_(std::move(path)), size_(size) {}

 private:
  std::string path_;
  std::uint64_t size_;
};

/// A file on a disk is read as it is asked for; "-", pipes and devices are read whole. Throws InputError.
std::shared_ptr<const ByteSource> open_bytes(const std::string& path);
std::shared_ptr<const ByteSource> bytes_in_memory(const std::string& path, std::vector<std::byte> bytes);

}  // namespace sinew::io
