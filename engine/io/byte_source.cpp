#include "engine/io/byte_source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "engine/geometry/check.h"
#include "engine/geometry/error.h"
#include "engine/io/io.h"

namespace sinew::io {

namespace {

class MemorySource : public ByteSource {
 public:
  MemorySource(const std::string& path, std::vector<std::byte> bytes)
      : ByteSource(path, bytes.size()), bytes_(std::move(bytes)) {}
  void read(std::uint64_t at, std::span<std::byte> bytes) const override {
    CHECK(at <= bytes_.size() && bytes.size() <= bytes_.size() - at, at, bytes.size());
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at), bytes.size(), bytes.begin());
  }

 private:
  std::vector<std::byte> bytes_;
};

class FileSource : public ByteSource {
 public:
  FileSource(const std::string& path, int file, std::uint64_t size) : ByteSource(path, size), file_(file) {}
  FileSource(const FileSource&) = delete;
  FileSource& operator=(const FileSource&) = delete;
  ~FileSource() override { close(file_); }
  void read(std::uint64_t at, std::span<std::byte> bytes) const override {
    constexpr std::size_t most = std::size_t{1} << 30;  // of one call
    while (!bytes.empty()) {
      const ssize_t got = pread(file_, bytes.data(), std::min(bytes.size(), most), static_cast<off_t>(at));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw file_error(path(), "a file that can be read", sinew::quoted(std::strerror(errno)));
      if (got == 0)
        throw byte_error(path(), static_cast<std::int64_t>(at), std::to_string(bytes.size()) + " more bytes",
                         "the end of a file that has become shorter");
      at += static_cast<std::uint64_t>(got);
      bytes = bytes.subspan(static_cast<std::size_t>(got));
    }
  }

 private:
  int file_;
};

}  // namespace

std::vector<std::byte> ByteSource::read(std::uint64_t at, std::size_t count) const {
  CHECK(at <= size_ && count <= size_ - at, at, count, size_);
  std::vector<std::byte> bytes(count);
  read(at, bytes);
  return bytes;
}

std::shared_ptr<const ByteSource> open_bytes(const std::string& path) {
  struct stat status;
  // Asked before it is opened: a pipe that is opened twice loses what was written in between.
  const bool regular = path != "-" && stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode);
  const int file = regular ? open(path.c_str(), O_RDONLY | O_CLOEXEC) : -1;
  if (file < 0) return bytes_in_memory(path, load_bytes(path));
  return std::make_shared<FileSource>(path, file, static_cast<std::uint64_t>(status.st_size));
}

std::shared_ptr<const ByteSource> bytes_in_memory(const std::string& path, std::vector<std::byte> bytes) {
  return std::make_shared<MemorySource>(path, std::move(bytes));
}

}  // namespace sinew::io
