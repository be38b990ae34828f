#include "engine/io/pc2.h"

#include <algorithm>
#include <cmath>

#include "engine/geometry/error.h"
#include "engine/io/frame_pattern.h"
#include "engine/io/point_cache.h"
#include "engine/io/text.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

constexpr std::string_view magic{"POINTCACHE2\0", 12};
constexpr std::size_t header_size = 32;
constexpr bool swap = std::endian::native != std::endian::little;

std::vector<std::byte> make_header(std::size_t points, const std::vector<int>& frames, double rate,
                                   WriteReport& report) {
  int step = frames.size() > 1 ? frames[1] - frames[0] : 1;
  for (std::size_t i = 1; i < frames.size() && step > 0; ++i)
    if (frames[i] - frames[i - 1] != step) step = 0;
  if (step == 0) {
    report.lost.push_back("PC2 cannot hold the frames " + frames_text(frames) +
                          ": they follow each other without gaps.");
    step = 1;
  }
  if (rate != 24) report.lost.push_back("PC2 cannot hold the rate of " + shortest(rate) + " frames a second.");
  std::vector<std::byte> header(header_size);
  std::memcpy(header.data(), magic.data(), magic.size());
  store(header.data() + 12, std::int32_t{1}, swap);
  store(header.data() + 16, static_cast<std::int32_t>(points), swap);
  store(header.data() + 20, static_cast<float>(frames.front()), swap);
  store(header.data() + 24, static_cast<float>(step), swap);
  store(header.data() + 28, static_cast<std::int32_t>(frames.size()), swap);
  return header;
}

constexpr PointCacheKind pc2{"PC2", false, make_header};

/// Numbers of the samples; counted from 1 where start and sampling give none.
void number_samples(PointCache& cache, std::size_t samples) {
  const auto start = static_cast<double>(load<float>(cache.header.data() + 20, swap));
  const auto sampling = static_cast<double>(load<float>(cache.header.data() + 24, swap));
  const double last = start + sampling * static_cast<double>(samples - 1);
  const bool whole = std::round(start) == start && std::round(sampling) == sampling && sampling >= 1 &&
                     std::abs(start) < 1e8 && std::abs(last) < 1e8;
  for (std::size_t i = 0; i < samples; ++i)
    cache.frames.push_back(
        static_cast<int>(whole ? start + sampling * static_cast<double>(i) : static_cast<double>(i + 1)));
  if (!whole)
    cache.notes.push_back("Its samples begin at " + shortest(start) + " and are " + shortest(sampling) +
                          " frames apart: they are counted from 1.");
}

PointCache parse(const ByteSource& bytes) {
  PointCache cache;
  cache.kind = &pc2;
  cache.header = bytes.read(0, static_cast<std::size_t>(std::min<std::uint64_t>(header_size, bytes.size())));
  ByteCursor cursor(bytes.path(), cache.header);
  if (!as_text(cache.header).starts_with(magic))
    throw byte_error(bytes.path(), 0, "a PC2 file (\"POINTCACHE2\")",
                     cache.header.empty() ? "an empty file" : sinew::quoted(as_text(cache.header).substr(0, 12)));
  cursor.take(magic.size(), "the magic");
  const auto version = cursor.number<std::int32_t>(false, "the version");
  if (version != 1) throw byte_error(bytes.path(), 12, "version 1", std::to_string(version));
  const auto points = cursor.number<std::int32_t>(false, "the count of points");
  cursor.number<float>(false, "the start");
  cursor.number<float>(false, "the sampling");
  const auto samples = cursor.number<std::int32_t>(false, "the count of samples");
  check_point_cache(bytes, header_size, points, samples);
  cache.points = static_cast<std::size_t>(points);
  number_samples(cache, static_cast<std::size_t>(samples));
  const std::uint64_t behind = bytes.size() - header_size - cache.frames.size() * cache.frame_size();
  if (behind > 0) cache.notes.push_back(std::to_string(behind) + " bytes after the last sample are not read.");
  return cache;
}

}  // namespace

Shape read_pc2(const std::string& path, std::vector<std::byte> bytes, const ReadOptions&) {
  const auto source = bytes_in_memory(path, std::move(bytes));
  return read_point_cache(*source, parse(*source));
}

std::vector<std::byte> write_pc2(const std::string& path, const Shape& shape, WriteReport& report) {
  return write_point_cache(pc2, path, shape, report);
}

Sequence open_pc2(std::shared_ptr<const ByteSource> bytes, const ReadOptions&) {
  PointCache cache = parse(*bytes);
  return open_point_cache(std::move(bytes), std::move(cache));
}

std::unique_ptr<FrameWriter> create_pc2(const std::string& path, const FrameWriterOptions& options) {
  return std::make_unique<PointCacheWriter>(pc2, path, options);
}

}  // namespace sinew::io
