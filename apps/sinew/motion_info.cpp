#include "apps/sinew/motion_info.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/geometry/bounds.h"
#include "engine/io/io.h"
#include "engine/io/motion.h"
#include "engine/io/text.h"

namespace sinew::app {

namespace {

struct MotionInfo {
  std::string path;
  io::Trajectories motion;
  io::GapReport gaps;
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();  ///< of all frames
  bool empty = true;                            ///< no point was ever seen

  const char* representation() const { return motion.rest.empty() ? "markers" : "skeleton"; }
  std::size_t places() const { return motion.names.size() * motion.frames.size(); }
  std::string frame_range() const {
    const auto last = motion.first_frame + static_cast<std::int64_t>(motion.frames.size()) - 1;
    const std::string first = std::to_string(motion.first_frame);
    return motion.frames.size() == 1 ? first : first + "-" + std::to_string(last);
  }
};

MotionInfo info_of(const std::string& path, const std::string& from) {
  MotionInfo info;
  info.path = path;
  info.motion = io::read_motion(path, from);
  info.gaps = io::gaps_of(info.motion);
  for (const auto& frame : info.motion.frames) {
    const Bounds bounds = bounds_of(frame);
    if (bounds.empty()) continue;
    info.min = info.empty ? bounds.min : info.min.cwiseMin(bounds.min);
    info.max = info.empty ? bounds.max : info.max.cwiseMax(bounds.max);
    info.empty = false;
  }
  return info;
}

void write_gaps(document::JsonWriter& out, const io::GapReport& report) {
  out.key("gaps");
  out.begin_array(false);
  for (const auto& marker : report.markers) {
    if (marker.gaps.empty()) continue;
    out.begin_object();
    out.key("name");
    out.text(marker.name);
    out.key("not_seen");
    write_value(out, marker.released);
    out.key("frames");
    out.begin_array(true);
    for (const io::Gap& gap : marker.gaps) {
      out.begin_array(true);
      write_value(out, gap.first);
      write_value(out, gap.last);
      out.end_array();
    }
    out.end_array();
    out.end_object();
  }
  out.end_array();
}

void write_json(document::JsonWriter& out, const MotionInfo& info) {
  const auto member = [&](const char* name, const auto& value) {
    out.key(name);
    write_value(out, value);
  };
  const io::Trajectories& motion = info.motion;
  out.begin_object();
  member("file", info.path);
  member("representation", info.representation());
  member("points", motion.names.size());
  member("bones", motion.bones.size());
  member("frames", motion.frames.size());
  member("frame_range", info.frame_range());
  if (motion.rate > 0) member("rate", motion.rate);
  if (!motion.unit.empty()) member("unit", motion.unit);
  member("not_seen", info.gaps.released);
  if (!info.empty) {
    out.key("bounds");
    out.begin_object();
    member("min", info.min);
    member("max", info.max);
    member("diagonal", (info.max - info.min).norm());
    out.end_object();
  }
  member("names", motion.names);
  write_gaps(out, info.gaps);
  member("notes", motion.notes);
  out.end_object();
}

void print_row(const char* name, const std::string& value) {
  fmt::print("  {:<16}{}\n", name, value);
}

void print_rows(const char* name, const std::vector<std::string>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) print_row(i == 0 ? name : "", values[i]);
}

/// Names in lines of a screen's width.
std::vector<std::string> lines_of(const std::vector<std::string>& names) {
  constexpr std::size_t width = 100;
  std::vector<std::string> lines;
  for (const std::string& name : names) {
    if (lines.empty() || lines.back().size() + name.size() > width) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : ", ") + name;
  }
  return lines;
}

void print_text(const MotionInfo& info) {
  const io::Trajectories& motion = info.motion;
  const auto point = [](const Vec3& p) {
    return io::shortest(p.x()) + " " + io::shortest(p.y()) + " " + io::shortest(p.z());
  };
  fmt::print("{}\n", info.path);
  print_row("representation", info.representation());
  print_row("points", std::to_string(motion.names.size()));
  if (!motion.bones.empty()) print_row("bones", std::to_string(motion.bones.size()));
  print_row("frames", fmt::format("{}: {}{}", motion.frames.size(), info.frame_range(),
                                  motion.rate > 0 ? ", " + io::shortest(motion.rate) + " a second" : ""));
  if (!motion.unit.empty()) print_row("unit", motion.unit);
  if (!info.empty) {
    print_row("min", point(info.min));
    print_row("max", point(info.max));
    print_row("diagonal", fmt::format("{:.6g}", (info.max - info.min).norm()));
  }
  print_rows("names", lines_of(motion.names));
  print_row("not seen", fmt::format("{} of {}", info.gaps.released, info.places()));
  for (const auto& marker : info.gaps.markers) {
    const auto longest = std::max_element(marker.gaps.begin(), marker.gaps.end(), [](const auto& a, const auto& b) {
      return a.last - a.first < b.last - b.first;
    });
    if (longest == marker.gaps.end()) continue;
    print_row("", fmt::format("{}: {} in {} gap{}, the longest {}-{}", marker.name, marker.released, marker.gaps.size(),
                              marker.gaps.size() == 1 ? "" : "s", longest->first, longest->last));
  }
  print_rows("notes", motion.notes);
}

}  // namespace

bool is_motion(const std::string& path, const std::string& from) {
  const io::MotionFormat* format = io::motion_format_of(path, from);
  const auto shapes = io::formats();
  return format != nullptr && std::none_of(shapes.begin(), shapes.end(), [&](const io::Format& shape) {
           return std::find(shape.extensions.begin(), shape.extensions.end(), format->extension) !=
                  shape.extensions.end();
         });
}

void show_motion(const std::string& path, const std::string& from, document::JsonWriter* json) {
  const MotionInfo info = info_of(path, from);
  json != nullptr ? write_json(*json, info) : print_text(info);
}

}  // namespace sinew::app
