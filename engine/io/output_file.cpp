#include "engine/io/output_file.h"

#include <fcntl.h>
#include <stdio.h>  // renameat2
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "engine/geometry/error.h"
#include "engine/io/shared_file.h"

namespace sinew::io {

namespace {

/// The errno of a failed call in words.
std::string reason() {
  return sinew::quoted(std::strerror(errno));
}

bool is_special(const std::string& path) {
  struct stat status;
  return path == "-" || (stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode));
}

/// Makes a new file beside `target` and opens it; -1 and an empty name where that fails.
int open_temporary(const std::filesystem::path& target, std::string& name) {
  static std::atomic<unsigned> counter{0};
  for (int tries = 0; tries < 100; ++tries) {
    const std::string last = ".sinew-" + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".part";
    name = (target.parent_path() / last).string();
    const int file = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) return file;
    if (errno != EEXIST) break;
  }
  name.clear();
  return -1;
}

/// The file that a name stands for, through links, whether it is there or not.
std::string target_of(const std::string& path) {
  std::filesystem::path target(path);
  std::error_code error;
  for (int links = 0; links < 40 && std::filesystem::is_symlink(target, error); ++links) {
    const std::filesystem::path next = std::filesystem::read_symlink(target, error);
    if (error) break;
    target = target.parent_path() / next;  // an absolute one stands for itself
  }
  return target.string();
}

/// Owner and mode of the file that is replaced. Root may give a file to another; anybody else owns what he writes.
bool keep_mode(int file, const struct stat& status) {
  if (fchown(file, status.st_uid, status.st_gid) != 0 && fchown(file, static_cast<uid_t>(-1), status.st_gid) != 0)
    errno = 0;
  return fchmod(file, status.st_mode & 07777) == 0;
}

}  // namespace

void refuse_existing(const std::string& path, bool force) {
  if (is_special(path)) return;
  struct stat status;
  if (stat(path.c_str(), &status) != 0) return;
  if (S_ISDIR(status.st_mode)) throw file_error(path, "the name of a file to write", "a folder");
  if (!force) throw file_error(path, "the name of a new file", "an existing one (--force replaces it)");
}

OutputFile::OutputFile(const std::string& path, bool force) : path_(path), target_(path), force_(force) {
  if (path.empty()) throw file_error("\"\"", "the name of a file to write", "no name");
  refuse_existing(path, force);
  if (is_special(path)) {
    file_ = path == "-" ? dup(STDOUT_FILENO) : open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (file_ < 0) fail("a file that can be written");
    return;
  }
  target_ = target_of(path);
  struct stat status;
  const bool exists = stat(target_.c_str(), &status) == 0;
  file_ = open_temporary(target_, temporary_);
  if (file_ < 0) fail("a folder that can be written");
  if (!exists || keep_mode(file_, status)) return;
  const InputError error = file_error(path_, "to keep the mode of the file", reason());
  close(file_);
  unlink(temporary_.c_str());
  throw error;
}

OutputFile::~OutputFile() {
  if (file_ >= 0) close(file_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

void OutputFile::fail(const std::string& expected) const {
  throw file_error(path_, expected, reason());
}

void OutputFile::write(std::span<const std::byte> bytes) {
  constexpr std::size_t most = std::size_t{1} << 30;  // of one call
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), std::min(bytes.size(), most));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("room for " + std::to_string(bytes.size()) + " more bytes");
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void OutputFile::write_at(std::uint64_t at, std::span<const std::byte> bytes) {
  if (!write_all_at(file_, at, bytes))
    fail("room for " + std::to_string(bytes.size()) + " bytes at byte " + std::to_string(at));
}

void OutputFile::commit() {
  if (temporary_.empty()) {
    const int result = close(file_);
    file_ = -1;
    if (result != 0) fail("to finish writing");
    return;
  }
  const int synced = fsync(file_), closed = close(file_);
  file_ = -1;
  if (synced != 0 || closed != 0) fail("to finish writing");
  int renamed = force_ ? -1 : renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE);
  // Not every file system can refuse to replace; whether the name is free was asked at the beginning.
  if (renamed != 0 && (force_ || errno == EINVAL)) renamed = rename(temporary_.c_str(), target_.c_str());
  if (renamed != 0) fail("to give the finished file its name");
  temporary_.clear();
  const std::string parent = std::filesystem::path(target_).parent_path().string();
  const int folder = open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) {
    if (errno == EACCES) return;  // it can be written but not read: the file is there
    fail("to bring the file's new name to the disk");
  }
  // Not every file system knows fsync of folders.
  const bool kept = fsync(folder) == 0 || errno == EINVAL;
  const int error = errno;
  close(folder);
  errno = error;
  if (!kept) fail("to bring the file's new name to the disk");
}

}  // namespace sinew::io
