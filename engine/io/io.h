#pragma once
/// Reading and writing shapes: a table from extension to functions. One file per format, reader and writer together.
///
/// Writers change as little as can be: where a shape came from the same format, its file's bytes are copied and only
/// values that differ from those read are replaced (so nothing else of the file can change); from another format, what
/// the target can hold is written and `WriteReport::lost` names the rest.

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew::io {

struct ReadOptions {
  /// Called with 0..1 now and then; false cancels: the reader throws Cancelled. May be empty.
  std::function<bool(double)> progress;
};
struct Cancelled {};  ///< thrown by a reader whose progress said false

struct WriteReport {
  std::vector<std::string> lost;  ///< one sentence for each thing that the format cannot hold
};

class ByteSource;
class FrameWriter;
struct FrameWriterOptions;

/// A file to write: a name relative to a folder, and its bytes.
struct NamedBytes {
  std::string name;
  std::vector<std::byte> bytes;
  bool operator==(const NamedBytes&) const = default;
};

struct Format {
  std::string name;                     ///< "PLY"
  std::vector<std::string> extensions;  ///< lower case, without the dot
  std::string help;                     ///< what of the format is read and written, one line
  /// Parses the bytes of a file; `path` is only for messages and for files beside it (mtl, scans of a set).
  Shape (*read)(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
  /// The bytes of a file that holds `shape`. Null where the format is only read.
  std::vector<std::byte> (*write)(const std::string& path, const Shape& shape, WriteReport& report);
  /// Where a file holds many frames (sequence.h): opening it, and making one. Null where it holds one; `read` then
  /// gives the first. Origins of the frames are set.
  Sequence (*open_frames)(std::shared_ptr<const ByteSource> bytes, const ReadOptions& options) = nullptr;
  std::unique_ptr<FrameWriter> (*create_frames)(const std::string& path, const FrameWriterOptions& options) = nullptr;
  bool tets = false;  ///< holds Shape::tets
  /// Where a shape takes more than one file: those beside `path`, with their paths. Null where one holds it all.
  std::vector<NamedBytes> (*write_beside)(const std::string& path, const Shape& shape) = nullptr;
};

std::span<const Format> formats();

/// The format of a path by its extension; throws InputError that lists the known ones.
const Format& format_of(const std::string& path);

/// The same, of a path or, where that is "-", of `as`.
const Format& format_of(const std::string& path, const std::string& as);

/// All files that hold `shape`, first that of `path`; `report` names what the format cannot hold. Not for a format
/// whose `write` is null.
std::vector<NamedBytes> files_of(const Format& format, const std::string& path, const Shape& shape,
                                 WriteReport& report);
/// The sentence that tets are not written, where the shape has some and the format holds none.
void report_lost_tets(const Format& format, std::size_t tets, WriteReport& report);

/// Reads a file ("-" with `as` an extension: standard input). Sets the shape's origin. Throws InputError or Cancelled.
std::shared_ptr<const Shape> read(const std::string& path, const ReadOptions& options = {}, const std::string& as = "");

/// Writes whole or not at all: a temporary file beside `path`, fsync, rename. An existing file is refused unless
/// `force`; devices and pipes are written as they are.
/// "-" with `as` an extension: standard output. A .conf is written with its scans beside it, as by write_parts; so are
/// the files of TetGen.
WriteReport write(const std::string& path, const Shape& shape, bool force = false, const std::string& as = "");

/// A scan set back to one file a scan, each in its own frame and under its own name, in `folder` (made if missing),
/// with the set's .conf. All files are made before the first is written; each is written whole or not at all. Throws
/// InputError where the shape has no parts.
WriteReport write_parts(const std::string& folder, const Shape& shape, bool force = false);

/// The whole of a file. Throws InputError (missing, folder, unreadable).
std::vector<std::byte> load_bytes(const std::string& path);
/// Whole or not at all, as write().
void save_bytes(const std::string& path, std::span<const std::byte> bytes, bool force);

}  // namespace sinew::io
