#include "engine/io/stream.h"

#include <sys/stat.h>

#include <algorithm>
#include <limits>

#include "engine/geometry/error.h"
#include "engine/io/bytes.h"
#include "engine/io/input_file.h"
#include "engine/io/output_file.h"
#include "engine/io/ply.h"
#include "engine/io/ply_vertices.h"
#include "engine/io/shared_file.h"

namespace sinew::io {

namespace {

constexpr std::size_t most_points = std::size_t{1} << 17, most_bytes = std::size_t{1} << 24;
constexpr std::size_t chunk = std::size_t{1} << 20;
constexpr std::size_t longest_header = std::size_t{1} << 24;

/// A file whose first bytes have been looked at already.
class Source {
 public:
  explicit Source(const std::string& path) : path_(path), file_(path) {}

  /// The bytes from the beginning to the end of the line "end_header"; all of the file where there is none.
  std::string_view look_for_header() {
    static constexpr std::string_view end = "\nend_header", end_mac = "\rend_header";
    for (std::size_t from = 0;;) {
      const std::size_t size = seen_.size();
      seen_.resize(size + chunk);
      seen_.resize(size + file_.read(std::span(seen_).subspan(size)));
      const std::string_view text = as_text(seen_);
      const std::size_t at = std::min(text.find(end, from), text.find(end_mac, from));
      const bool whole = at != std::string_view::npos && text.size() - at > end.size() + 2;
      if (whole || seen_.size() < size + chunk || seen_.size() > longest_header) return text;
      from = size > end.size() ? size - end.size() : 0;
    }
  }

  std::size_t read(std::span<std::byte> bytes) {
    const std::size_t kept = std::min(bytes.size(), seen_.size() - used_);
    std::copy_n(seen_.begin() + static_cast<std::ptrdiff_t>(used_), kept, bytes.begin());
    used_ += kept;
    const std::size_t got = kept + (kept < bytes.size() ? file_.read(bytes.subspan(kept)) : 0);
    at_ += got;
    return got;
  }

  /// All of the file; only before the first read().
  std::vector<std::byte> rest() {
    std::vector<std::byte> bytes = std::move(seen_);
    for (;;) {
      const std::size_t size = bytes.size();
      bytes.resize(size + std::max(size, chunk));
      const std::size_t got = file_.read(std::span(bytes).subspan(size));
      if (size + got < bytes.size()) {
        bytes.resize(size + got);
        return bytes;
      }
    }
  }

  /// Goes on reading at byte `at`; only for a file that has a size.
  void seek(std::uint64_t at) {
    used_ = seen_.size();
    file_.seek(at_ = at);
  }

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return file_.size().value_or(0); }
  std::uint64_t at() const { return at_; }
  std::optional<std::uint64_t> left() const {
    return file_.size() && *file_.size() >= at_ ? std::optional(*file_.size() - at_) : std::nullopt;
  }

 private:
  std::string path_;
  InputFile file_;
  std::vector<std::byte> seen_;
  std::size_t used_ = 0;  ///< bytes of seen_ that read() has given
  std::uint64_t at_ = 0;
};

using Write = std::function<void(std::span<const std::byte>)>;

InputError truncated(const Source& source, const PlyElement& element, std::uint64_t left) {
  return byte_error(source.path(), static_cast<std::int64_t>(source.at()),
                    std::to_string(element.count) + " rows of " + quoted(element.name) + " of " +
                        std::to_string(element.row_size()) + " bytes",
                    "only " + std::to_string(left) + " bytes to the end of the file");
}

/// Refuses a count that the rest of the file cannot hold, where its size is known.
void check_rows(const Source& source, const PlyElement& element) {
  const auto left = source.left();
  if (left && element.row_size() > 0 && element.count > *left / element.row_size())
    throw truncated(source, element, *left);
}

void copy_bytes(Source& source, const Write& write, std::uint64_t size, const PlyElement& element) {
  std::vector<std::byte> buffer(static_cast<std::size_t>(std::min<std::uint64_t>(size, chunk)));
  while (size > 0) {
    const auto part = std::span(buffer).first(static_cast<std::size_t>(std::min<std::uint64_t>(size, buffer.size())));
    const std::size_t got = source.read(part);
    if (got < part.size()) throw truncated(source, element, 0);
    write(part);
    size -= got;
  }
}

void copy_rest(Source& source, const Write& write) {
  std::vector<std::byte> buffer(chunk);
  while (const std::size_t got = source.read(buffer)) write(std::span(buffer).first(got));
}

/// `points` points, which come next in `source`, block by block.
void bend_points(Source& source, const Write& write, const PlyHeader& header, std::uint64_t points,
                 const StreamOptions& options, const std::function<void(Shape&)>& bend) {
  const PlyElement& vertices = header.vertices();
  const PlyVertices layout = layout_of(header);
  const std::size_t block_points = std::clamp<std::size_t>(most_bytes / layout.stride, 1, most_points);
  std::vector<std::byte> rows;
  Shape block;
  block.origin = options.origin;
  block.position_type = layout.position_type;
  block.attributes = layout.attributes;
  for (std::uint64_t done = 0; done < points;) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(block_points, points - done));
    rows.resize(count * layout.stride);
    if (const std::size_t got = source.read(rows); got < rows.size()) throw truncated(source, vertices, 0);
    block.positions.clear();
    for (Attribute& attribute : block.attributes) attribute.values.clear();
    append_rows(layout, rows, block);
    bend(block);
    CHECK(block.size() == count, block.size(), count);
    patch_rows(layout, block, 0, rows);
    write(rows);
    done += count;
    if (options.progress && !options.progress(static_cast<double>(done) / static_cast<double>(points)))
      throw Cancelled{};
  }
}

/// Points and all before them have rows of fixed size.
bool can_stream(const PlyHeader& header) {
  if (header.encoding == PlyEncoding::Ascii) return false;
  return std::none_of(header.elements.begin(), header.elements.begin() + static_cast<std::ptrdiff_t>(header.vertex + 1),
                      [](const PlyElement& element) { return element.has_list(); });
}

/// Bytes of the rows that come next in `source`. Refuses more than can be.
std::uint64_t bytes_of_rows(const Source& source, const PlyElement& element) {
  if (element.properties.empty()) return 0;
  check_rows(source, element);
  if (element.count > std::numeric_limits<std::uint64_t>::max() / element.row_size())
    throw truncated(source, element, 0);
  return element.count * element.row_size();
}

void stream_ply(Source& source, const PlyHeader& header, OutputFile& out, const StreamOptions& options,
                const std::function<void(Shape&)>& bend) {
  const Write write = [&out](std::span<const std::byte> bytes) { out.write(bytes); };
  copy_bytes(source, write, header.size, header.vertices());
  for (std::size_t e = 0; e < header.vertex; ++e)
    copy_bytes(source, write, bytes_of_rows(source, header.elements[e]), header.elements[e]);
  bytes_of_rows(source, header.vertices());
  bend_points(source, write, header, header.vertices().count, options, bend);
  copy_rest(source, write);
}

const Format& format_for(const std::string& path, const std::string& as) {
  return format_of(path == "-" && !as.empty() ? "-." + as : path);
}

WriteReport bend_whole(const std::string& in, std::vector<std::byte> bytes, const std::string& out,
                       const StreamOptions& options, const std::function<void(Shape&)>& bend) {
  ReadOptions reading;
  if (options.progress) reading.progress = [&options](double x) { return options.progress(x / 2); };
  const Format& format = format_for(in, options.as);
  refuse_lfs_pointer(in, bytes, format.name);
  Shape shape = format.read(in, std::move(bytes), reading);
  shape.origin = options.origin;
  for (Vec3& p : shape.positions) p -= options.origin;
  const std::size_t count = shape.size();
  bend(shape);
  CHECK(shape.size() == count, shape.size(), count);
  if (options.progress && !options.progress(1)) throw Cancelled{};
  return write(out, shape, options.force, options.as);
}

/// Both where they are there: links are followed.
bool are_same_file(const std::string& a, const std::string& b) {
  struct stat first, second;
  return stat(a.c_str(), &first) == 0 && stat(b.c_str(), &second) == 0 && first.st_dev == second.st_dev &&
         first.st_ino == second.st_ino;
}

/// The first task also copies what comes before the points, the last what follows them.
void bend_share(Source& source, const PlyHeader& header, SharedFile& file, const StreamOptions& options,
                const std::function<void(Shape&)>& bend) {
  const PlyElement& vertices = header.vertices();
  const std::uint64_t first = options.share->first(vertices.count), last = options.share->last(vertices.count);
  const std::uint64_t begin = source.at(), end = begin + vertices.count * vertices.row_size();
  std::uint64_t at = 0;
  const Write write = [&](std::span<const std::byte> bytes) {
    file.write_at(at, bytes);
    at += bytes.size();
  };
  const auto go_to = [&](std::uint64_t byte) { source.seek(at = byte); };
  go_to(0);
  if (options.share->index == 1) copy_bytes(source, write, begin, vertices);
  go_to(begin + first * vertices.row_size());
  bend_points(source, write, header, last - first, options, bend);
  go_to(end);
  if (options.share->index == options.share->count) copy_rest(source, write);
}

void stream_share(const std::string& in, const std::string& out, const StreamOptions& options,
                  const std::function<void(Shape&)>& bend) {
  static const std::string expected = "a binary PLY without lists up to its points, which tasks can share";
  const Format& from = format_for(in, options.as);
  const Format& to = format_for(out, options.as);
  if (from.read != read_ply) throw file_error(in, expected, from.name);
  if (to.write != write_ply) throw file_error(out, "a PLY as the input is, which tasks can share", to.name);
  struct stat status;
  if (in == "-" || (stat(in.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)))
    throw file_error(in, "a file on a disk, which tasks can share", "a pipe or a device");
  Source source(in);
  const std::span<const std::byte> seen = std::as_bytes(std::span(source.look_for_header()));
  refuse_lfs_pointer(in, seen, from.name);
  const PlyHeader header = parse_ply_header(in, as_text(seen));
  if (header.encoding == PlyEncoding::Ascii) throw file_error(in, expected, "a text");
  if (!can_stream(header)) throw file_error(in, expected, "lists");
  if (are_same_file(in, out)) throw file_error(out, "another file than the input", "the input itself");
  source.seek(header.size);
  for (std::size_t e = 0; e < header.vertex; ++e) source.seek(source.at() + bytes_of_rows(source, header.elements[e]));
  bytes_of_rows(source, header.vertices());  // no output is made for what is truncated
  SharedFile file(out, source.size(), seen.first(header.size), options.force);
  bend_share(source, header, file, options, bend);
  file.commit();
}

}  // namespace

WriteReport stream(const std::string& in, const std::string& out, const StreamOptions& options,
                   const std::function<void(Shape& block)>& bend) {
  if (options.share) {
    stream_share(in, out, options, bend);
    return {};
  }
  const Format& from = format_for(in, options.as);
  const Format& to = format_for(out, options.as);
  refuse_existing(out, options.force);
  Source source(in);
  if (from.read != read_ply || to.write != write_ply) return bend_whole(in, source.rest(), out, options, bend);
  const std::string_view seen = source.look_for_header();
  if (seen.find("end_header") == std::string_view::npos) return bend_whole(in, source.rest(), out, options, bend);
  const PlyHeader header = parse_ply_header(in, seen);
  if (!can_stream(header)) return bend_whole(in, source.rest(), out, options, bend);
  OutputFile file(out, options.force);
  stream_ply(source, header, file, options, bend);
  file.commit();
  return {};
}

}  // namespace sinew::io
