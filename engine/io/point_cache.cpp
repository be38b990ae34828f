#include "engine/io/point_cache.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/geometry/error.h"
#include "engine/io/frame_pattern.h"
#include "engine/io/text.h"
#include "engine/io/text_patch.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

/// Of a frame.
struct PointCacheContent : FileContent {
  std::shared_ptr<const PointCache> cache;
  std::vector<std::byte> coordinates;  ///< as the file has them
};

bool is_swapped(const PointCacheKind& kind) {
  return kind.big_endian != (std::endian::native == std::endian::big);
}

Shape read_frame(const ByteSource& bytes, const std::shared_ptr<const PointCache>& cache, std::size_t i) {
  auto content = std::make_shared<PointCacheContent>();
  content->cache = cache;
  content->coordinates = bytes.read(cache->header.size() + i * cache->frame_size(), cache->frame_size());
  Shape shape;
  shape.positions.resize(cache->points);
  shape.notes = cache->notes;
  const std::byte* at = content->coordinates.data();
  for (Vec3& p : shape.positions)
    for (int c = 0; c < 3; ++c, at += sizeof(float))
      p[c] = static_cast<double>(load<float>(at, is_swapped(*cache->kind)));
  shape.content = std::move(content);
  return shape;
}

/// The content of a shape that came from the same format and has as many points.
const PointCacheContent* content_of(const PointCacheKind& kind, const Shape& shape) {
  const auto* content = dynamic_cast<const PointCacheContent*>(shape.content.get());
  const bool same = content != nullptr && content->cache->kind == &kind && content->cache->points == shape.size();
  return same ? content : nullptr;
}

void check_points(const PointCacheKind& kind, const std::string& path, const Shape& shape) {
  if (shape.size() < 1 || shape.size() > std::numeric_limits<std::int32_t>::max())
    throw file_error(path, std::string("1 to 2147483647 points for ") + kind.name, std::to_string(shape.size()));
}

std::vector<std::byte> coordinates_of(const PointCacheKind& kind, const Shape& shape, WriteReport& report) {
  const PointCacheContent* content = content_of(kind, shape);
  std::vector<std::byte> out = content != nullptr ? content->coordinates : std::vector<std::byte>(12 * shape.size());
  std::byte* at = out.data();
  for (const Vec3& p : shape.positions)
    for (int c = 0; c < 3; ++c, at += sizeof(float)) {
      const bool swap = is_swapped(kind);
      if (content != nullptr && same_coordinate(static_cast<double>(load<float>(at, swap)), shape.origin[c], p[c]))
        continue;
      store(at, static_cast<float>(p[c] + shape.origin[c]), swap);
    }
  if (!shape.faces.empty())
    report.lost.push_back(std::string(kind.name) + " cannot hold " + counted(shape.faces.size(), "face", "faces") +
                          ".");
  report_lost_precision(kind.name, shape, report);
  report_lost_attributes(kind.name, shape, {}, report);
  return out;
}

}  // namespace

void check_point_cache(const ByteSource& bytes, std::uint64_t header_size, std::int64_t points, std::int64_t frames) {
  if (points < 1) throw file_error(bytes.path(), "at least one point", std::to_string(points));
  if (frames < 1) throw file_error(bytes.path(), "at least one frame", std::to_string(frames));
  const auto frame = static_cast<std::uint64_t>(points) * 12;
  const std::uint64_t left = bytes.size() < header_size ? 0 : bytes.size() - header_size;
  if (static_cast<std::uint64_t>(frames) > left / frame)
    throw byte_error(bytes.path(), static_cast<std::int64_t>(header_size),
                     std::to_string(frames) + " frames of " + std::to_string(points) + " points of 12 bytes",
                     "only " + std::to_string(left) + " bytes to the end of the file");
}

Sequence open_point_cache(std::shared_ptr<const ByteSource> bytes, PointCache cache) {
  Sequence sequence;
  sequence.frames = cache.frames;
  sequence.rate = cache.rate;
  sequence.load = [bytes, cache = std::make_shared<const PointCache>(std::move(cache))](int frame) {
    const auto at = std::lower_bound(cache->frames.begin(), cache->frames.end(), frame);
    CHECK(at != cache->frames.end() && *at == frame, frame);
    auto shape = std::make_shared<Shape>(
        read_frame(*bytes, cache, static_cast<std::size_t>(std::distance(cache->frames.begin(), at))));
    set_origin(*shape);
    return shape;
  };
  return sequence;
}

Shape read_point_cache(const ByteSource& bytes, PointCache cache) {
  if (cache.frames.size() > 1)
    cache.notes.push_back("Only the first of " + std::to_string(cache.frames.size()) + " frames is read.");
  return read_frame(bytes, std::make_shared<const PointCache>(std::move(cache)), 0);
}

std::vector<std::byte> write_point_cache(const PointCacheKind& kind, const std::string& path, const Shape& shape,
                                         WriteReport& report) {
  check_points(kind, path, shape);
  std::vector<std::byte> out = kind.header(shape.size(), {1}, 24, report);
  const std::vector<std::byte> coordinates = coordinates_of(kind, shape, report);
  out.insert(out.end(), coordinates.begin(), coordinates.end());
  return out;
}

PointCacheWriter::PointCacheWriter(const PointCacheKind& kind, std::string path, const FrameWriterOptions& options)
    : kind_(kind), path_(std::move(path)), options_(options), written_(options.frames.size(), false) {
  if (path_ == "-" && options_.frames.size() > 1)
    throw file_error(path_, std::string("the name of a file for ") + kind.name, "standard output");
  if (!options_.share) refuse_existing(path_, options_.force);
}

/// The first frame that comes tells how many points there are.
void PointCacheWriter::open(const Shape& shape) {
  check_points(kind_, path_, shape);
  points_ = shape.size();
  const PointCacheContent* content = content_of(kind_, shape);
  const bool as_read =
      content != nullptr && content->cache->frames == options_.frames && content->cache->rate == options_.rate;
  const std::vector<std::byte> header =
      as_read ? content->cache->header : kind_.header(points_, options_.frames, options_.rate, header_report_);
  header_size_ = header.size();
  const std::uint64_t size = header_size_ + options_.frames.size() * points_ * 12;
  if (options_.share) {
    file_.emplace<SharedFile>(path_, size, header, options_.force);
  } else {
    file_.emplace<OutputFile>(path_, options_.force).write(header);
  }
}

void PointCacheWriter::write(int frame, const Shape& shape) {
  const auto at = std::lower_bound(options_.frames.begin(), options_.frames.end(), frame);
  CHECK(at != options_.frames.end() && *at == frame, frame);
  const auto i = static_cast<std::size_t>(std::distance(options_.frames.begin(), at));
  WriteReport report;
  const std::vector<std::byte> bytes = coordinates_of(kind_, shape, report);
  {
    const std::scoped_lock lock(mutex_);
    if (file_.index() == 0) open(shape);
    if (shape.size() != points_)
      throw file_error(path_,
                       "as many points in frame " + std::to_string(frame) + " as in others, " + std::to_string(points_),
                       std::to_string(shape.size()));
  }
  if (auto* shared = std::get_if<SharedFile>(&file_)) {
    shared->write_at(header_size_ + i * bytes.size(), bytes);
  } else if (auto* file = std::get_if<OutputFile>(&file_)) {
    // Standard output has one frame only, the one behind the header.
    path_ == "-" ? file->write(bytes) : file->write_at(header_size_ + i * bytes.size(), bytes);
  }
  losses_.add(frame, std::move(report));
  const std::scoped_lock lock(mutex_);
  written_[i] = true;
}

WriteReport PointCacheWriter::commit() {
  std::vector<int> missing;
  for (const int frame : options_.own_frames())
    if (const auto at = std::lower_bound(options_.frames.begin(), options_.frames.end(), frame);
        !written_[static_cast<std::size_t>(std::distance(options_.frames.begin(), at))])
      missing.push_back(frame);
  if (!missing.empty())
    throw file_error(path_, "all of its " + std::to_string(options_.own_frames().size()) + " frames",
                     "no frame " + frames_text(missing));
  if (auto* shared = std::get_if<SharedFile>(&file_)) shared->commit();
  if (auto* file = std::get_if<OutputFile>(&file_)) file->commit();
  WriteReport report = header_report_;
  for (std::string& sentence : losses_.merged().lost) report.lost.push_back(std::move(sentence));
  return report;
}

}  // namespace sinew::io
