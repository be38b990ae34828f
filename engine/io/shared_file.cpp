#include "engine/io/shared_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "engine/geometry/error.h"

namespace sinew::io {

namespace {

/// The first `count` bytes of a file; fewer where it ends or cannot be read.
std::vector<std::byte> first_bytes(const std::string& path, std::size_t count) {
  std::vector<std::byte> bytes(count);
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const ssize_t got = file < 0 ? 0 : pread(file, bytes.data(), bytes.size(), 0);
  // A page that is kept would be written back whole by some clients of network file systems, see below.
  if (file >= 0) posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED);
  if (file >= 0) close(file);
  bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  return bytes;
}

}  // namespace

SharedFile::SharedFile(const std::string& path, std::uint64_t size, std::span<const std::byte> header, bool force)
    : path_(path) {
  struct stat status;
  if (path == "-" || (stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)))
    throw file_error(path, "a file on a disk, which tasks can share",
                     path != "-" && S_ISDIR(status.st_mode) ? "a folder" : "a pipe or a device");
  // Only for writing: a client of a network file system that may read as well fills up the pages that it writes to and
  // sends them whole, with what they held before another machine wrote its part.
  file_ = open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
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
/// what it has, and write the same header. Nor is room reserved: where posix_fallocate has to write for that, it writes
/// over what others have written.
void SharedFile::make(std::uint64_t size, std::span<const std::byte> header, bool force) {
  struct stat status;
  if (fstat(file_, &status) != 0) fail("a file that can be written");
  const auto found_size = static_cast<std::uint64_t>(status.st_size);
  const std::vector<std::byte> found = first_bytes(path_, header.size());
  const bool empty = std::all_of(found.begin(), found.end(), [](std::byte b) { return b == std::byte{0}; });
  const bool same = std::equal(found.begin(), found.end(), header.begin(), header.end());
  const bool fits = found_size == 0 || (found_size == size && (empty || same));
  if (!fits && !force)
    throw file_error(
        path_, "a new file, or one of " + std::to_string(size) + " bytes that tasks of this output have begun",
        found_size == size ? "another one with another header (--force replaces it)"
                           : "another one of " + std::to_string(found_size) + " bytes (--force replaces it)");
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
