#include "engine/io/motion.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "engine/io/bvh.h"
#include "engine/io/bytes.h"
#include "engine/io/c3d.h"
#include "engine/io/io.h"
#include "engine/io/marker_csv.h"
#include "engine/io/trc.h"

namespace sinew::io {

namespace {

const std::vector<MotionFormat>& table() {
  static const std::vector<MotionFormat> rows{
      {"C3D", "c3d", "markers; integers and floats of Intel, DEC and MIPS; analog channels are skipped", read_c3d},
      {"TRC", "trc", "markers in text with tabs between", read_trc},
      {"BVH", "bvh", "skeletons; any channels in any order; places and turns of joints by forward kinematics",
       read_bvh},
      {"Markers", "csv", "in CSV; columns NAME.x, NAME.y, NAME.z, frame, time", read_marker_csv, write_marker_csv},
  };
  return rows;
}

/// Lower case, with the dot.
std::string extension_of(const std::string& path, const std::string& as) {
  std::string extension = path == "-" && !as.empty() ? "." + as : std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

}  // namespace

std::span<const MotionFormat> motion_formats() {
  return table();
}

const MotionFormat* motion_format_of(const std::string& path, const std::string& as) {
  const std::string extension = extension_of(path, as);
  const auto row =
      std::find_if(table().begin(), table().end(), [&](const auto& f) { return "." + f.extension == extension; });
  return row == table().end() ? nullptr : &*row;
}

bool is_motion(const std::string& path) {
  const MotionFormat* format = motion_format_of(path);
  if (format == nullptr || format->read != read_marker_csv) return format != nullptr;
  std::ifstream file(path, std::ios::binary);
  std::string row(1 << 20, '\0');  // longer than any row of names
  file.read(row.data(), static_cast<std::streamsize>(row.size()));
  row.resize(static_cast<std::size_t>(file.gcount()));
  return names_markers(row.substr(0, row.find_first_of("\r\n")));
}

Trajectories read_motion(const std::string& path, const std::string& as) {
  const MotionFormat* format = motion_format_of(path, as);
  if (format == nullptr) {
    std::string known;
    for (const MotionFormat& f : table()) known += (known.empty() ? "." : ", .") + f.extension;
    const std::string extension = extension_of(path, as);
    throw file_error(path, "a name that ends in " + known,
                     extension.empty() ? "no extension" : sinew::quoted(extension));
  }
  const std::vector<std::byte> bytes = load_bytes(path);
  refuse_lfs_pointer(path, bytes, format->name);
  return format->read(path, bytes);
}

double rate_of_step(double seconds) {
  if (!(seconds > 0) || !std::isfinite(1 / seconds)) return 0;
  const double rate = 1 / seconds, whole = std::round(rate);
  return std::abs(rate - whole) < 2e-5 * whole ? whole : rate;
}

void check_places(const std::string& path, std::size_t frames, std::size_t points, std::size_t bytes) {
  constexpr std::size_t per_byte = 4;  // a point that is there takes 3 bytes and more of a row
  if (frames > 0 && points > per_byte * bytes / frames)
    throw file_error(
        path,
        "at most " + std::to_string(per_byte * bytes) + " places of points in " + std::to_string(bytes) + " bytes",
        std::to_string(frames) + " frames of " + std::to_string(points) + " points");
}

}  // namespace sinew::io
