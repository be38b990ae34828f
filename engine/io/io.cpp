#include "engine/io/io.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "engine/geometry/error.h"
#include "engine/io/obj.h"
#include "engine/io/output_file.h"
#include "engine/io/ply.h"

namespace sinew::io {

namespace {

/// A row is a format: its reader and writer are all that is known of it here.
const std::vector<Format>& table() {
  static const std::vector<Format> rows{
      {"PLY", {"ply"}, "ascii and binary; points, faces, strips; everything else is kept", read_ply, write_ply},
      {"OBJ", {"obj"}, "points, colours, normals, faces; everything else is kept", read_obj, write_obj},
  };
  return rows;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

/// The format of a path, or of `as` where the path is "-".
const Format& format_for(const std::string& path, const std::string& as) {
  if (path != "-") return format_of(path);
  if (as.empty()) throw file_error("-", "the format of the stream, by an extension", "none");
  return format_of("-." + as);
}

/// Closes when it goes.
struct InputFile {
  int file;
  explicit InputFile(int f) : file(f) {}
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile() {
    if (file >= 0) close(file);
  }
};

}  // namespace

std::span<const Format> formats() {
  return table();
}

const Format& format_of(const std::string& path) {
  std::string extension = lower(std::filesystem::path(path).extension().string());
  if (!extension.empty()) extension.erase(0, 1);
  std::string known;
  for (const Format& format : formats())
    for (const std::string& e : format.extensions) {
      if (e == extension) return format;
      known += (known.empty() ? "." : ", .") + e;
    }
  throw file_error(path, "a name that ends in " + known,
                   extension.empty() ? "no extension" : sinew::quoted("." + extension));
}

std::vector<std::byte> load_bytes(const std::string& path) {
  const InputFile in(path == "-" ? dup(STDIN_FILENO) : open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat status;
  if (in.file < 0 || fstat(in.file, &status) != 0)
    throw file_error(path, "a file that can be read", sinew::quoted(std::strerror(errno)));
  if (S_ISDIR(status.st_mode)) throw file_error(path, "a file", "a folder");
  // One byte more than the file has: its end is seen without another buffer.
  std::vector<std::byte> bytes((S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 1 << 20) + 1);
  std::size_t size = 0;
  for (;;) {
    if (size == bytes.size()) bytes.resize(2 * size);
    const ssize_t got = ::read(in.file, bytes.data() + size, std::min(bytes.size() - size, std::size_t{1} << 30));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw file_error(path, "a file that can be read", sinew::quoted(std::strerror(errno)));
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
  }
  bytes.resize(size);
  return bytes;
}

void save_bytes(const std::string& path, std::span<const std::byte> bytes, bool force) {
  OutputFile out(path, force);
  out.write(bytes);
  out.commit();
}

std::shared_ptr<const Shape> read(const std::string& path, const ReadOptions& options, const std::string& as) {
  const Format& format = format_for(path, as);
  auto shape = std::make_shared<Shape>(format.read(path, load_bytes(path), options));
  set_origin(*shape);
  return shape;
}

WriteReport write(const std::string& path, const Shape& shape, bool force, const std::string& as) {
  const Format& format = format_for(path, as);
  if (format.write == nullptr) throw file_error(path, "a format that can be written", format.name);
  refuse_existing(path, force);
  WriteReport report;
  save_bytes(path, format.write(path, shape, report), force);
  return report;
}

}  // namespace sinew::io
