#include <fmt/core.h>

#include <algorithm>

#include "apps/sinew/command.h"
#include "apps/sinew/files.h"
#include "engine/document/json.h"
#include "engine/document/report.h"
#include "engine/geometry/bounds.h"
#include "engine/io/text.h"

namespace sinew::app {

namespace {

struct Options {
  std::vector<std::string> files;
  bool json = false;
  std::string from;
};

/// What is shown of a file.
struct Info {
  std::string path;
  document::InputReport input;
  std::size_t not_finite = 0;
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();  ///< in the file's coordinates
  double diagonal = 0;
  bool empty = false;  ///< no finite point: no bounds
  std::shared_ptr<const Shape> shape;
};

Info info_of(const std::string& path, const std::string& from) {
  Info info;
  info.path = path;
  info.shape = read_input(path, from);
  const Shape& shape = *info.shape;
  info.input = document::report_of(shape);
  info.not_finite = static_cast<std::size_t>(
      std::count_if(shape.positions.begin(), shape.positions.end(), [](const Vec3& p) { return !p.allFinite(); }));
  const Bounds bounds = bounds_of(shape.positions);
  info.empty = bounds.empty();
  if (info.empty) return info;
  info.min = bounds.min + shape.origin;
  info.max = bounds.max + shape.origin;
  info.diagonal = bounds.diagonal();
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
  print_row("points", std::to_string(info.input.points) +
                          (info.not_finite > 0 ? fmt::format(" ({} not finite)", info.not_finite) : ""));
  print_row("faces", std::to_string(info.input.faces));
  print_row("components", std::to_string(info.input.components));
  print_row("frames", std::to_string(info.input.frames));
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
  arguments.positionals("FILE", options->files, "Files to look at; - with --from");
  arguments.flag("--json", options->json, "One JSON object; for several files an array of them");
  arguments.option("--from", "EXT", options->from, "Format of standard input, by an extension");
  return [options] { return run(*options); };
}

}  // namespace sinew::app
