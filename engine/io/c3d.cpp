#include "engine/io/c3d.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/io/bytes.h"
#include "engine/io/c3d_parameters.h"
#include "engine/io/text.h"

namespace sinew::io {

namespace {

constexpr std::size_t block = 512;

/// The 512 bytes at the beginning of the file.
struct Header {
  std::size_t points = 0, analog = 0;  ///< analog: values a frame, of all channels
  int first = 0, last = 0;             ///< frames
  double scale = 0, rate = 0;
  std::size_t data_block = 0;  ///< from 1
  std::size_t samples = 0;     ///< of each analog channel a frame
};

/// How the frames lie in the file.
struct Layout {
  std::size_t points = 0, analog = 0;
  double scale = 0;
  std::size_t begin = 0;  ///< byte

  std::size_t number_size() const { return scale < 0 ? 4 : 2; }
  std::size_t frame_size() const { return (4 * points + analog) * number_size(); }
};

/// What one place in the file says of the frames.
struct Range {
  std::int64_t first = 1, count = 0;
  std::string by;  ///< "the header"
};

struct Chosen {
  Layout layout;
  Range range;
};

/// Blocks count from 1; 0, which is none, gives 0, where no data can begin.
std::size_t byte_of_block(std::size_t number) {
  return number > 0 ? (number - 1) * block : 0;
}

/// The block of the parameters, which the first byte tells, as a byte.
std::size_t parameters_at(const std::string& path, std::span<const std::byte> bytes) {
  ByteCursor cursor(path, bytes);
  const auto head = cursor.take(2, "a C3D file");
  if (head[1] != std::byte{0x50})
    throw byte_error(path, 1, "a C3D file (80 as its second byte)", std::to_string(std::to_integer<int>(head[1])));
  const auto number = std::to_integer<std::size_t>(head[0]);
  if (number < 2) throw byte_error(path, 0, "the block of the parameters, from 2 on", std::to_string(number));
  cursor.take(block - 2, "the header");
  if (byte_of_block(number) >= bytes.size())
    throw byte_error(path, 0,
                     "the block of the parameters, within the file of " + std::to_string(bytes.size()) + " bytes",
                     std::to_string(number));
  return byte_of_block(number);
}

Header read_header(C3dProcessor processor, std::span<const std::byte> bytes) {
  const auto word = [&](std::size_t i) { return c3d_word(processor, &bytes[2 * (i - 1)]); };  // words count from 1
  Header header;
  header.points = word(2);
  header.analog = word(3);
  header.first = word(4);
  header.last = word(5);
  header.scale = c3d_float(processor, &bytes[12]);
  header.data_block = word(9);
  header.samples = word(10);
  header.rate = c3d_float(processor, &bytes[20]);
  return header;
}

/// Where the data begin by the header: parameters end there at the latest. Their own count of blocks is wrong in many
/// files.
std::size_t parameters_end(std::span<const std::byte> bytes, std::size_t begin) {
  if (begin + 4 > bytes.size()) return bytes.size();
  const bool mips = bytes[begin + 3] == static_cast<std::byte>(C3dProcessor::Mips);
  const std::size_t data = c3d_word(mips ? C3dProcessor::Mips : C3dProcessor::Intel, &bytes[16]);
  const std::size_t end = byte_of_block(data);
  return end > begin ? std::min(end, bytes.size()) : bytes.size();
}

bool is_scale(double x) {
  return std::isfinite(x) && x != 0;
}

/// A parameter that is a count; nothing where it is none, or one that no file holds.
std::optional<std::size_t> count_of(const C3dParameters& parameters, std::string_view group, std::string_view name) {
  const auto number = parameters.number(group, name);
  if (!number || !(*number >= 0 && *number <= 1e9)) return std::nullopt;
  return static_cast<std::size_t>(*number);
}

/// The layout by the parameters; what they do not say is the header's.
Layout layout_of(const C3dParameters& parameters, const Header& header) {
  Layout layout{header.points, header.analog, header.scale, byte_of_block(header.data_block)};
  layout.points = count_of(parameters, "POINT", "USED").value_or(layout.points);
  if (const auto scale = parameters.number("POINT", "SCALE"); scale && is_scale(*scale)) layout.scale = *scale;
  if (const auto start = count_of(parameters, "POINT", "DATA_START"); start && *start >= 2)
    layout.begin = byte_of_block(*start);
  const auto channels = count_of(parameters, "ANALOG", "USED");
  if (channels && (*channels == 0 || header.samples > 0)) layout.analog = *channels * header.samples;
  return layout;
}

/// 32 bits in two words, the low one first.
std::optional<std::int64_t> long_frame(const C3dParameters& parameters, std::string_view name) {
  const auto low = parameters.number("TRIAL", name, 0), high = parameters.number("TRIAL", name, 1);
  if (!low || !high || !(*low <= 65535 && *high <= 65535)) return std::nullopt;
  return static_cast<std::int64_t>(*low) + 65536 * static_cast<std::int64_t>(*high);
}

/// All that the file says of its frames, the most trustworthy first.
std::vector<Range> ranges_of(const C3dParameters& parameters, const Header& header) {
  std::vector<Range> ranges;
  std::int64_t first = header.first;
  const auto start = long_frame(parameters, "ACTUAL_START_FIELD"), end = long_frame(parameters, "ACTUAL_END_FIELD");
  if (start) first = *start;
  if (start && end) ranges.push_back({*start, *end - *start + 1, "TRIAL:ACTUAL_END_FIELD"});
  const auto add = [&](const char* name) {
    if (const auto count = parameters.number("POINT", name); count && *count >= 1 && *count <= 4294967295.0)
      ranges.push_back({first, static_cast<std::int64_t>(*count), std::string("POINT:") + name});
  };
  add("LONG_FRAMES");
  ranges.push_back({header.first, header.last - header.first + 1, "the header"});
  add("FRAMES");
  std::erase_if(ranges,
                [](const Range& r) { return r.count < 1 || r.first > std::numeric_limits<int>::max() - r.count; });
  return ranges;
}

/// The first pair of a layout and a range that fills the file up to its last block; else the first that fits into it.
/// Throws InputError where none does.
Chosen choose(const std::string& path, const std::vector<Layout>& layouts, const std::vector<Range>& ranges,
              std::size_t size) {
  std::optional<Chosen> fits;
  for (const Layout& layout : layouts) {
    if (layout.points == 0 || !is_scale(layout.scale) || layout.begin < block || layout.begin > size) continue;
    for (const Range& range : ranges) {
      const std::size_t left = size - layout.begin, frames = static_cast<std::size_t>(range.count);
      if (frames > left / layout.frame_size()) continue;
      if (left - frames * layout.frame_size() < block) return {layout, range};
      if (!fits) fits = {layout, range};
    }
  }
  if (fits) return *fits;
  const Layout& layout = layouts.front();
  if (layout.points == 0) throw file_error(path, "at least one point", "0");
  if (!is_scale(layout.scale))
    throw byte_error(path, 12, "the scale of the points, which is not zero", shortest(layout.scale));
  if (ranges.empty()) throw file_error(path, "at least one frame", "0");
  const std::size_t begin = std::min(layout.begin, size);
  throw byte_error(
      path, static_cast<std::int64_t>(layout.begin),
      std::to_string(ranges.front().count) + " frames of " + std::to_string(layout.frame_size()) + " bytes",
      "only " + std::to_string(size - begin) + " bytes to the end of the file");
}

/// Sentences on what parameters and header say differently; what counts is in `chosen`.
void note_differences(Trajectories& out, const C3dParameters& parameters, const Header& header,
                      const std::vector<Range>& ranges, const Chosen& chosen) {
  const auto differ = [&](const std::string& what, double parameter, double word, double counts) {
    if (parameter != word)
      out.notes.push_back(what + " is " + shortest(parameter) + ", the header has " + shortest(word) + ": " +
                          shortest(counts) + " counts.");
  };
  const Layout wanted = layout_of(parameters, header);
  const auto real = [](std::size_t x) { return static_cast<double>(x); };
  differ("POINT:USED", real(wanted.points), real(header.points), real(chosen.layout.points));
  differ("POINT:SCALE", wanted.scale, header.scale, chosen.layout.scale);
  differ("The count of analog values in a frame", real(wanted.analog), real(header.analog), real(chosen.layout.analog));
  const auto start = parameters.number("POINT", "DATA_START");
  if (start) differ("POINT:DATA_START", *start, real(header.data_block), real(chosen.layout.begin / block + 1));
  if (const auto rate = parameters.number("POINT", "RATE")) differ("POINT:RATE", *rate, header.rate, out.rate);
  for (const Range& range : ranges)
    if (range.count != chosen.range.count)
      out.notes.push_back("By " + range.by + " there are " + std::to_string(range.count) + " frames, by " +
                          chosen.range.by + " " + std::to_string(chosen.range.count) + ", which are read.");
}

/// POINT:LABELS, LABELS2, ... one after the other, each of up to 255; "*3" where point 3 has none.
std::vector<std::string> names_of(const C3dParameters& parameters, std::size_t points) {
  std::vector<std::string> names;
  for (std::size_t i = 1; names.size() < points; ++i) {
    const std::vector<std::string> more = parameters.texts("POINT", i == 1 ? "LABELS" : "LABELS" + std::to_string(i));
    if (more.empty()) break;
    names.insert(names.end(), more.begin(), more.end());
  }
  names.resize(points);
  for (std::size_t i = 0; i < points; ++i)
    if (names[i].empty()) names[i] = "*" + std::to_string(i + 1);
  return names;
}

Vec3 point_of(C3dProcessor processor, const std::byte* at, double scale) {
  double x[4];
  if (scale < 0)
    for (std::size_t c = 0; c < 4; ++c) x[c] = c3d_float(processor, at + 4 * c);
  else  // the residual and the mask of cameras share the fourth word, whose sign is that of the residual
    for (std::size_t c = 0; c < 4; ++c)
      x[c] = (c < 3 ? scale : 1.0) * static_cast<double>(static_cast<std::int16_t>(c3d_word(processor, at + 2 * c)));
  const Vec3 p(x[0], x[1], x[2]);
  return x[3] >= 0 && p.allFinite() ? p : not_seen;
}

std::vector<std::vector<Vec3>> frames_of(C3dProcessor processor, std::span<const std::byte> bytes,
                                         const Chosen& chosen) {
  const Layout& layout = chosen.layout;
  std::vector<std::vector<Vec3>> frames(static_cast<std::size_t>(chosen.range.count), std::vector<Vec3>(layout.points));
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (std::size_t p = 0; p < layout.points; ++p) {
      const std::size_t at = layout.begin + f * layout.frame_size() + 4 * p * layout.number_size();
      frames[f][p] = point_of(processor, &bytes[at], layout.scale);
    }
  return frames;
}

}  // namespace

Trajectories read_c3d(const std::string& path, std::span<const std::byte> bytes) {
  const std::size_t begin = parameters_at(path, bytes);
  const C3dParameters parameters(path, bytes, begin, parameters_end(bytes, begin));
  const Header header = read_header(parameters.processor(), bytes);
  const Layout by_header{header.points, header.analog, header.scale, byte_of_block(header.data_block)};
  const std::vector<Range> ranges = ranges_of(parameters, header);
  const Chosen chosen = choose(path, {layout_of(parameters, header), by_header}, ranges, bytes.size());

  Trajectories out;
  out.first_frame = static_cast<int>(chosen.range.first);
  const auto good = [](std::optional<double> rate) { return rate && std::isfinite(*rate) && *rate > 0; };
  const auto rate = parameters.number("POINT", "RATE");
  out.rate = good(rate) ? *rate : good(header.rate) ? header.rate : 0;
  out.unit = parameters.text("POINT", "UNITS");
  out.names = names_of(parameters, chosen.layout.points);
  out.notes = parameters.notes();
  note_differences(out, parameters, header, ranges, chosen);
  for (const char* axis : {"X_SCREEN", "Y_SCREEN"})
    if (const std::string text = parameters.text("POINT", axis); !text.empty())
      out.notes.push_back(std::string("POINT:") + axis + " is " + quoted(text) + ".");
  out.frames = frames_of(parameters.processor(), bytes, chosen);
  return out;
}

}  // namespace sinew::io
