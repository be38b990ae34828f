#pragma once
/// What PC2 and MDD share: a header, and for each frame the coordinates of all points as 32-bit floats. A frame lies at
/// a place that is known beforehand, so it is read alone, and frames are written in any order and by several processes.

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <variant>

#include "engine/io/byte_source.h"
#include "engine/io/frame_losses.h"
#include "engine/io/output_file.h"
#include "engine/io/sequence.h"
#include "engine/io/shared_file.h"

namespace sinew::io {

/// What the two differ in.
struct PointCacheKind {
  const char* name;
  bool big_endian;
  /// The header of a file with these frames; what it cannot hold goes to the report.
  std::vector<std::byte> (*header)(std::size_t points, const std::vector<int>& frames, double rate,
                                   WriteReport& report);
};

/// A file, its header read.
struct PointCache {
  const PointCacheKind* kind = nullptr;
  std::vector<std::byte> header;
  std::size_t points = 0;
  std::vector<int> frames;
  double rate = 24;
  std::vector<std::string> notes;

  std::size_t frame_size() const { return points * 3 * sizeof(float); }
};

/// Checks that the frames that a header tells of are there: `points` and `frames` are at least 1 and fit into the bytes
/// behind `header_size`. Throws InputError.
void check_point_cache(const ByteSource& bytes, std::uint64_t header_size, std::int64_t points, std::int64_t frames);

Sequence open_point_cache(std::shared_ptr<const ByteSource> bytes, PointCache cache);
/// The first frame, with a note where there are more.
Shape read_point_cache(const ByteSource& bytes, PointCache cache);
/// A file of one frame, number 1. Throws InputError: no point, or more than 2^31 - 1.
std::vector<std::byte> write_point_cache(const PointCacheKind& kind, const std::string& path, const Shape& shape,
                                         WriteReport& report);

/// Where frames, rate and count of points are those that were read, with the header that was read; coordinates that did
/// not change keep their bits.
class PointCacheWriter : public FrameWriter {
 public:
  PointCacheWriter(const PointCacheKind& kind, std::string path, const FrameWriterOptions& options);
  void write(int frame, const Shape& shape) override;
  WriteReport commit() override;

 private:
  void open(const Shape& shape);

  const PointCacheKind& kind_;
  std::string path_;
  FrameWriterOptions options_;
  std::mutex mutex_;  ///< of the members below but for writes into the opened file
  std::size_t points_ = 0, header_size_ = 0;
  std::variant<std::monostate, OutputFile, SharedFile> file_;
  std::vector<bool> written_;
  WriteReport header_report_;
  FrameLosses losses_;
};

}  // namespace sinew::io
