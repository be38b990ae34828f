#include "engine/io/shared_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "engine/geometry/error.h"

namespace sinew::io {

SharedFile::SharedFile(const std::string& path, std::uint64_t size, std::span<const std::byte> header, bool force)
    : path_(path), file_(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (file_ < 0) fail("a file that can be written");
  try {
    make(size, header, force);
  } catch (...) {
    close(file_);
    throw;
  }
}

SharedFile::~SharedFile() {
  if (file_ >= 0) close(file_);
}

void SharedFile::fail(const std::string& expected) const {
  throw file_error(path_, expected, sinew::quoted(std::strerror(errno)));
}

/// Nothing is locked, since not every file system can: two that make the file at once set the same size, which keeps
/// what it has, and write the same header.
void SharedFile::make(std::uint64_t size, std::span<const std::byte> header, bool force) {
  struct stat status;
  if (fstat(file_, &status) != 0) fail("a file that can be written");
  if (!S_ISREG(status.st_mode)) throw file_error(path_, "a file on a disk for tasks that share it", "none");
  const auto found_size = static_cast<std::uint64_t>(status.st_size);
  std::vector<std::byte> found(header.size());
  const ssize_t got = pread(file_, found.data(), found.size(), 0);
  if (got < 0) fail("a file that can be read");
  const bool empty = std::all_of(found.begin(), found.end(), [](std::byte b) { return b == std::byte{0}; });
  const bool same = std::equal(found.begin(), found.end(), header.begin());
  const bool fits = found_size == 0 || (found_size == size && (empty || same));
  if (!fits && !force)
    throw file_error(
        path_,
        "the name of a new file, or of one of " + std::to_string(size) + " bytes that tasks of this output write",
        "another one (--force replaces it)");
  if (found_size != size && ftruncate(file_, static_cast<off_t>(size)) != 0)
    fail("room for " + std::to_string(size) + " bytes");
  if (!same || found_size != size) write_at(0, header);
}

void SharedFile::write_at(std::uint64_t at, std::span<const std::byte> bytes) {
  if (!write_all_at(file_, at, bytes))
    fail("room for " + std::to_string(bytes.size()) + " bytes at byte " + std::to_string(at));
}

void SharedFile::commit() {
  const int synced = fsync(file_), closed = close(file_);
  file_ = -1;
  if (synced != 0 || closed != 0) fail("to finish writing");
}

bool write_all_at(int file, std::uint64_t at, std::span<const std::byte> bytes) {
  constexpr std::size_t most = std::size_t{1} << 30;  // of one call
  while (!bytes.empty()) {
    const ssize_t written = pwrite(file, bytes.data(), std::min(bytes.size(), most), static_cast<off_t>(at));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    at += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace sinew::io
