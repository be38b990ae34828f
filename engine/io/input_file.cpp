#include "engine/io/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "engine/geometry/error.h"

namespace sinew::io {

InputFile::InputFile(const std::string& path)
    : path_(path), file_(path == "-" ? dup(STDIN_FILENO) : open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
  struct stat status;
  if (file_ < 0 || fstat(file_, &status) != 0) {
    const InputError error = file_error(path, "a file that can be read", quoted(std::strerror(errno)));
    if (file_ >= 0) close(file_);
    throw error;
  }
  if (S_ISDIR(status.st_mode)) {
    close(file_);
    throw file_error(path, "a file", "a folder");
  }
  if (S_ISREG(status.st_mode)) size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() {
  close(file_);
}

std::size_t InputFile::read(std::span<std::byte> bytes) {
  constexpr std::size_t most = std::size_t{1} << 30;  // of one call
  std::size_t size = 0;
  while (size < bytes.size()) {
    const ssize_t got = ::read(file_, bytes.data() + size, std::min(bytes.size() - size, most));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw file_error(path_, "a file that can be read", quoted(std::strerror(errno)));
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
  }
  return size;
}

void InputFile::seek(std::uint64_t at) {
  if (lseek(file_, static_cast<off_t>(at), SEEK_SET) < 0)
    throw file_error(path_, "a file that can be read at byte " + std::to_string(at), quoted(std::strerror(errno)));
}

}  // namespace sinew::io
