#include <fmt/core.h>

#include <algorithm>

#include "apps/sinew/command.h"
#include "apps/sinew/frames.h"
#include "apps/sinew/motion_info.h"
#include "apps/sinew/progress.h"
#include "engine/document/json.h"
#include "engine/document/report.h"
#include "engine/geometry/bounds.h"
#include "engine/io/frame_pattern.h"
#include "engine/io/io.h"
#include "engine/io/text.h"

namespace sinew::app {

namespace {

struct Options {
  std::vector<std::string> files;
  bool json = false;
  std::string from;
};

/// What is shown of a file or a sequence.
struct Info {
  std::string path;
  document::InputReport input;  ///< of the first frame, but for the count of frames
  std::vector<int> frames;
  double rate = 24;
  std::size_t least_points = 0, most_points = 0, not_finite = 0;  ///< of all frames
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();                    ///< of all frames, in the file's coordinates
  double diagonal = 0;
  bool empty = true;                   ///< no finite point: no bounds
  std::shared_ptr<const Shape> shape;  ///< the first frame
};

void add_frame(Info& info, const Shape& shape) {
  info.least_points = std::min(info.least_points, shape.size());
  info.most_points = std::max(info.most_points, shape.size());
  info.not_finite += static_cast<std::size_t>(
      std::count_if(shape.positions.begin(), shape.positions.end(), [](const Vec3& p) { return !p.allFinite(); }));
  const Bounds bounds = bounds_of(shape.positions);
  if (bounds.empty()) return;
  const Vec3 min = bounds.min + shape.origin, max = bounds.max + shape.origin;
  info.min = info.empty ? min : info.min.cwiseMin(min);
  info.max = info.empty ? max : info.max.cwiseMax(max);
  info.diagonal = info.frames.size() == 1 ? bounds.diagonal() : (info.max - info.min).norm();
  info.empty = false;
}

Info info_of(const std::string& path, const std::string& from) {
  Info info;
  info.path = path;
  const Sequence sequence = open_input(path, from, "");
  info.frames = sequence.frames;
  info.rate = sequence.rate;
  info.shape = sequence.load(sequence.frames.front());
  info.input = document::report_of(*info.shape);
  info.input.frames = sequence.frames.size();
  info.least_points = info.most_points = info.shape->size();
  add_frame(info, *info.shape);
  Progress progress("reading " + path);
  for (std::size_t i = 1; i < sequence.frames.size(); ++i) {
    if (!progress(static_cast<double>(i) / static_cast<double>(sequence.frames.size()))) throw io::Cancelled();
    add_frame(info, *sequence.load(sequence.frames[i]));
  }
  return info;
}

template <class T>
void member(document::JsonWriter& out, const char* name, const T& value) {
  out.key(name);
  write_value(out, value);
}

void write_attribute(document::JsonWriter& out, const Attribute& attribute) {
  out.begin_object();
  member(out, "name", attribute.name);
  member(out, "type", name_of(attribute.type));
  member(out, "kind", name_of(attribute.kind));
  member(out, "components", attribute.components);
  member(out, "fields", attribute.fields);
  member(out, "count", attribute.count());
  out.end_object();
}

void write_json(document::JsonWriter& out, const Info& info) {
  const Shape& shape = *info.shape;
  out.begin_object();
  member(out, "file", info.path);
  document::write_members(out, info.input);
  if (info.frames.size() > 1) {
    member(out, "frame_range", io::frames_text(info.frames));
    member(out, "rate", info.rate);
    member(out, "least_points", info.least_points);
    member(out, "most_points", info.most_points);
  }
  member(out, "not_finite", info.not_finite);
  if (!info.empty) {
    out.key("bounds");
    out.begin_object();
    member(out, "min", info.min);
    member(out, "max", info.max);
    member(out, "diagonal", info.diagonal);
    out.end_object();
  }
  member(out, "position_type", name_of(shape.position_type));
  out.key("attributes");
  out.begin_array(false);
  for (const Attribute& attribute : shape.attributes) write_attribute(out, attribute);
  out.end_array();
  out.key("parts");
  out.begin_array(false);
  for (const Part& part : shape.parts) {
    out.begin_object();
    member(out, "path", part.path);
    member(out, "points", part.count);
    out.end_object();
  }
  out.end_array();
  out.key("notes");
  out.begin_array(false);
  for (const std::string& note : shape.notes) out.text(note);
  out.end_array();
  out.end_object();
}

void print_row(const char* name, const std::string& value) {
  fmt::print("  {:<16}{}\n", name, value);
}

std::string point(const Vec3& p) {
  return io::shortest(p.x()) + " " + io::shortest(p.y()) + " " + io::shortest(p.z());
}

void print_text(const Info& info) {
  const Shape& shape = *info.shape;
  fmt::print("{}\n", info.path);
  print_row("representation", info.input.representation);
  print_row("points",
            (info.least_points == info.most_points ? std::to_string(info.most_points)
                                                   : fmt::format("{} to {}", info.least_points, info.most_points)) +
                (info.not_finite > 0 ? fmt::format(" ({} not finite)", info.not_finite) : ""));
  print_row("faces", std::to_string(info.input.faces));
  if (info.input.tets > 0) print_row("tets", std::to_string(info.input.tets));
  print_row("components", std::to_string(info.input.components));
  print_row("frames", info.frames.size() == 1 ? "1"
                                              : fmt::format("{}: {}, {} a second", info.frames.size(),
                                                            io::frames_text(info.frames), io::shortest(info.rate)));
  if (!info.empty) {
    print_row("min", point(info.min));
    print_row("max", point(info.max));
    print_row("diagonal", fmt::format("{:.6g}", info.diagonal));
  }
  for (std::size_t i = 0; i < shape.attributes.size(); ++i) {
    const Attribute& a = shape.attributes[i];
    print_row(i == 0 ? "attributes" : "",
              fmt::format("{:<20} {} x {}, {}", a.name, name_of(a.type), a.components, name_of(a.kind)));
  }
  for (std::size_t i = 0; i < shape.parts.size(); ++i)
    print_row(i == 0 ? "scans" : "", fmt::format("{:<20} {} points", shape.parts[i].path, shape.parts[i].count));
}

int run(const Options& options) {
  document::JsonWriter out;
  const bool array = options.files.size() > 1;
  if (array) out.begin_array(false);
  for (const std::string& file : options.files) {
    if (is_motion(file, options.from)) {
      show_motion(file, options.from, options.json ? &out : nullptr);
      continue;
    }
    const Info info = info_of(file, options.from);
    if (options.json)
      write_json(out, info);
    else
      print_text(info);
  }
  if (array) out.end_array();
  if (options.json) fmt::print("{}", out.result());
  return Ok;
}

}  // namespace

std::function<int()> declare_info(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.positionals("FILE", options->files,
                        "Files and runs of files (run.####.obj), motion capture (walk.c3d) to look at; - with --from");
  arguments.flag("--json", options->json, "One JSON object; for several files an array of them");
  arguments.option("--from", "EXT", options->from, "Format of standard input, by an extension");
  return [options] { return run(*options); };
}

}  // namespace sinew::app
