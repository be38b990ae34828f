#include "engine/io/mdd.h"

#include <algorithm>

#include "engine/geometry/error.h"
#include "engine/io/frame_times.h"
#include "engine/io/point_cache.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

constexpr bool swap = std::endian::native != std::endian::big;

std::vector<std::byte> make_header(std::size_t points, const std::vector<int>& frames, double rate, WriteReport&) {
  std::vector<std::byte> header(8 + 4 * frames.size());
  store(header.data(), static_cast<std::int32_t>(frames.size()), swap);
  store(header.data() + 4, static_cast<std::int32_t>(points), swap);
  for (std::size_t i = 0; i < frames.size(); ++i)
    store(header.data() + 8 + 4 * i, static_cast<float>(frames[i] / rate), swap);
  return header;
}

constexpr PointCacheKind mdd{"MDD", true, make_header};

PointCache parse(const ByteSource& bytes) {
  PointCache cache;
  cache.kind = &mdd;
  const std::vector<std::byte> begin =
      bytes.read(0, static_cast<std::size_t>(std::min<std::uint64_t>(8, bytes.size())));
  ByteCursor cursor(bytes.path(), begin);
  const auto frames = cursor.number<std::int32_t>(true, "the count of frames");
  const auto points = cursor.number<std::int32_t>(true, "the count of points");
  const std::uint64_t header_size = 8 + 4 * std::uint64_t{static_cast<std::uint32_t>(std::max(frames, 0))};
  check_point_cache(bytes, header_size, points, frames);
  cache.points = static_cast<std::size_t>(points);
  cache.header = bytes.read(0, static_cast<std::size_t>(header_size));
  std::vector<float> times(static_cast<std::size_t>(frames));
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = load<float>(cache.header.data() + 8 + 4 * i, swap);
  FrameTimes numbers = frames_of_times(times);
  cache.frames = std::move(numbers.frames);
  cache.rate = numbers.rate;
  if (numbers.numbered) cache.notes.push_back("Its times are no multiples of one step: frames are counted from 1.");
  const std::uint64_t behind = bytes.size() - header_size - cache.frames.size() * cache.frame_size();
  if (behind > 0) cache.notes.push_back(std::to_string(behind) + " bytes after the last frame are not read.");
  return cache;
}

}  // namespace

Shape read_mdd(const std::string& path, std::vector<std::byte> bytes, const ReadOptions&) {
  const auto source = bytes_in_memory(path, std::move(bytes));
  return read_point_cache(*source, parse(*source));
}

std::vector<std::byte> write_mdd(const std::string& path, const Shape& shape, WriteReport& report) {
  return write_point_cache(mdd, path, shape, report);
}

Sequence open_mdd(std::shared_ptr<const ByteSource> bytes, const ReadOptions&) {
  PointCache cache = parse(*bytes);
  return open_point_cache(std::move(bytes), std::move(cache));
}

std::unique_ptr<FrameWriter> create_mdd(const std::string& path, const FrameWriterOptions& options) {
  return std::make_unique<PointCacheWriter>(mdd, path, options);
}

}  // namespace sinew::io
