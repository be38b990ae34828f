#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "apps/sinew/command.h"
#include "apps/sinew/files.h"
#include "apps/sinew/interrupt.h"
#include "apps/sinew/legend.h"
#include "apps/sinew/progress.h"
#include "apps/sinew/scene.h"
#include "deformers/methods.h"
#include "engine/document/edit.h"
#include "engine/document/markers.h"
#include "engine/document/settings.h"
#include "engine/geometry/error.h"
#include "engine/gpu/offscreen.h"
#include "engine/gpu/png.h"
#include "engine/io/frame_pattern.h"
#include "engine/io/io.h"
#include "engine/io/text.h"

namespace sinew::app {

namespace {

struct Options {
  std::string input, from, png, edit, frame, size = "1280x720", view = "iso", show, up = "y", point_size, cut,
                                             turntable, color, colormap, range;
  bool force = false;
};

int parse_side(const std::string& text, const std::string& whole) {
  std::int64_t side = 0;
  if (!io::parse(text, side) || side < 1 || side > 16384)
    throw UsageError("--size: expected WIDTHxHEIGHT, each from 1 to 16384, found " + sinew::quoted(whole));
  return static_cast<int>(side);
}

/// "z=0.5": what of the tets is shown.
std::optional<gpu::Section> section_of(const std::string& text) {
  if (text.empty()) return std::nullopt;
  gpu::Section out;
  const std::string axes = "xyz";
  const std::size_t axis = text.size() > 2 && text[1] == '=' ? axes.find(text[0]) : std::string::npos;
  if (axis == std::string::npos || !io::parse(text.substr(2), out.at) || !(out.at >= 0 && out.at <= 1))
    throw UsageError("--cut: expected an axis and a part from 0 to 1, such as z=0.5, found " + sinew::quoted(text));
  out.axis = static_cast<int>(axis);
  return out;
}

View view_of(const Options& options) {
  View view;
  view.name = options.view;
  const std::size_t x = std::min(options.size.find('x'), options.size.size());
  view.width = parse_side(options.size.substr(0, x), options.size);
  view.height = parse_side(x < options.size.size() ? options.size.substr(x + 1) : "", options.size);
  if (options.up != "y" && options.up != "z")
    throw UsageError("--up: expected y or z, found " + sinew::quoted(options.up));
  view.z_up = options.up == "z";
  view.section = section_of(options.cut);
  if (!options.point_size.empty() &&
      !(io::parse(options.point_size, view.point_size) && view.point_size >= 1 && view.point_size <= 64))
    throw UsageError("--point-size: expected 1 to 64 pixels, found " + sinew::quoted(options.point_size));
  return view;
}

/// "graph,handles"
std::set<std::string> shown(const std::string& text) {
  std::set<std::string> out;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string name = text.substr(begin, comma - begin);
    std::string known;
    for (const char* known_name : show_names) known += (known.empty() ? "" : ", ") + std::string(known_name);
    if (std::find(std::begin(show_names), std::end(show_names), name) == std::end(show_names))
      throw UsageError("--show: expected some of " + known + ", found " + sinew::quoted(name));
    out.insert(name);
    begin = comma + 1;
  }
  return out;
}

/// --color, --colormap and --range; `show` may name a field as well.
FieldOptions field_of(const Options& options, const std::set<std::string>& show) {
  FieldOptions out;
  out.name = options.color;
  for (const char* name : {"energy", "displacement"})
    if (show.contains(name)) out.name = name;
  const std::optional<gpu::Colormap> map =
      options.colormap.empty() ? gpu::Colormap::Viridis : gpu::colormap_named(options.colormap);
  if (!map)
    throw UsageError("--colormap: expected viridis, turbo or cool-warm, found " + sinew::quoted(options.colormap));
  out.map = *map;
  if (out.name.empty() && !(options.colormap.empty() && options.range.empty()))
    throw UsageError("--colormap and --range: expected --color with them, found none");
  if (options.range.empty()) return out;
  document::ValueRange range;
  const std::size_t comma = std::min(options.range.find(','), options.range.size());
  if (comma == options.range.size() || !io::parse(options.range.substr(0, comma), range.low) ||
      !io::parse(options.range.substr(comma + 1), range.high) || !(range.low < range.high) ||
      !std::isfinite(range.low) || !std::isfinite(range.high))
    throw UsageError("--range: expected two numbers, the lower first, such as 0,0.5, found " +
                     sinew::quoted(options.range));
  out.range = range;
  return out;
}

void check_fields(const Options& options, const std::set<std::string>& show, bool has_edit) {
  const bool energy = show.contains("energy"), displacement = show.contains("displacement");
  if (energy && displacement) throw UsageError("--show: expected energy or displacement, found both");
  if ((energy || displacement) && !options.color.empty())
    throw UsageError(fmt::format("--color {}: expected no other colours (--show), found some", options.color));
  if ((energy || displacement) && !has_edit)
    throw UsageError(
        fmt::format("--show {}: expected an edit (--edit), found none", energy ? "energy" : "displacement"));
}

/// Tets are there only where a layer's method makes some.
void check_tets(const Options& options, const std::set<std::string>& show, const document::Project& project) {
  if (!options.cut.empty() && !show.contains("tets")) throw UsageError("--cut: expected --show tets, found none");
  if (!show.contains("tets")) return;
  for (const document::Layer& layer : project.layers)
    if (layer.on && document::method_of(layer, methods()).parts.solid) return;
  throw UsageError("--show tets: expected an edit (--edit) with a layer of the method tet, found none");
}

void check_markers(const std::set<std::string>& show, const document::Project& project) {
  if (show.contains("markers") && document::driving_markers(project.layers) == nullptr)
    throw UsageError("--show markers: expected an edit (--edit) with a layer that has markers, found none");
}

int frame_of(const Options& options, const Sequence& sequence) {
  if (options.frame.empty()) return sequence.frames.front();
  std::int64_t frame = 0;
  if (!io::parse(options.frame, frame) || std::abs(frame) > 1'000'000'000)
    throw UsageError("--frame: expected the number of a frame, found " + sinew::quoted(options.frame));
  return static_cast<int>(frame);
}

/// The names of the pictures, in order: one, or of a turntable those of a numbered run.
std::vector<std::string> names_of(const Options& options, View& view) {
  if (!options.png.ends_with(".png")) throw UsageError(options.png + ": expected a name that ends in .png");
  const std::optional<io::FramePattern> pattern = io::frame_pattern(options.png);
  if (options.turntable.empty()) {
    if (pattern) throw UsageError(options.png + ": expected --turntable with the name of a run, found none");
    return {options.png};
  }
  std::int64_t count = 0;
  if (!io::parse(options.turntable, count) || count < 2 || count > 10'000)
    throw UsageError("--turntable: expected a number of pictures from 2 to 10000, found " +
                     sinew::quoted(options.turntable));
  if (!pattern || !pattern->frames.empty())
    throw UsageError(options.png + ": expected the name of a run, such as turn.####.png, with --turntable");
  view.turntable = static_cast<int>(count);
  std::vector<std::string> out;
  for (int i = 1; i <= view.turntable; ++i) out.push_back(pattern->path(i));
  return out;
}

void draw(const Shape& input, const document::Evaluation* evaluation, const View& view,
          const std::set<std::string>& show, std::span<const std::string> names) {
  const std::unique_ptr<gpu::Device> device = gpu::create_device({});
  const gpu::Paths paths = gpu::measure_paths(*device);
  const gpu::RendererHandle renderer = gpu::create_renderer(*device, paths, gpu::offscreen_format);
  const gpu::Offscreen offscreen =
      gpu::create_offscreen(*device, {static_cast<std::uint32_t>(view.width), static_cast<std::uint32_t>(view.height)});
  DrawnShape drawn;
  fill_scene(*device, input, evaluation, view, show, drawn);
  if (drawn.field)
    message(fmt::format("{}: colours from {:.4g} to {:.4g}{}; the most is {:.4g}", drawn.field->field.name,
                        drawn.field->range.low, drawn.field->range.high, drawn.field->field.unit, drawn.field->most));
  Progress progress("drawing");
  const Writing writing;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!progress(static_cast<double>(i) / static_cast<double>(names.size()))) throw io::Cancelled{};
    drawn.scene.camera = drawn.cameras[i];
    gpu::Picture picture = gpu::render_picture(*device, *renderer, offscreen, drawn.scene);
    if (drawn.field) draw_legend(picture, *drawn.field);
    io::save_bytes(names[i], gpu::png_bytes(picture), true);
  }
}

int run(const Options& options) {
  View view = view_of(options);
  const std::set<std::string> show = shown(options.show);
  check_fields(options, show, !options.edit.empty());
  view.color = field_of(options, show);
  const std::vector<std::string> names = names_of(options, view);
  for (const std::string& name : names) check_output_text(name, options.force);
  document::Project project;
  if (!options.edit.empty()) {
    project = document::read_edit(options.edit);
    document::check_layers(project.layers, methods());
  }
  check_tets(options, show, project);
  check_markers(show, project);
  const auto sequence = std::make_shared<const Sequence>(
      document::with_frames_of_markers(*open_input(options.input, options.from), project.layers));
  const int frame = view.frame = frame_of(options, *sequence);
  document::Workspace workspace(sequence, methods());
  const std::shared_ptr<const Shape> input = workspace.input(frame);
  for (const std::string& note : input->notes) message(options.input + ": " + note);
  std::optional<document::Evaluation> evaluation;
  if (!options.edit.empty()) {
    Progress progress("");
    document::EvaluateOptions evaluating;
    evaluating.progress = [&](const char* what, std::size_t layer, double f) {
      return progress(fmt::format("{} layer {}", what, layer + 1), f);
    };
    evaluation = document::evaluate(workspace, project.layers, frame, evaluating);
  }
  draw(*input, evaluation ? &*evaluation : nullptr, view, show, names);
  return Ok;
}

}  // namespace

std::function<int()> declare_render(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.positional("INPUT", options->input, "File to draw, or frames: name.####.obj; - with --from");
  arguments.option("-o,--output", "PNG", options->png, "Picture to write, or name.####.png with --turntable", true);
  arguments.option("-e,--edit", "EDIT.json", options->edit, "Draw the shape bent by this edit");
  arguments.option("--frame", "N", options->frame,
                   "Of frames (name.####.obj, name.pc2), keys or a motion; the first without");
  arguments.option("--size", "WxH", options->size, "Pixels; 1280x720 without");
  arguments.option("--view", "VIEW", options->view,
                   "front, back, left, right, top, bottom, iso (without), or eye and target ex,ey,ez,tx,ty,tz");
  arguments.option(
      "--show", "LIST", options->show,
      "Some of graph, tets (in place of the shape), handles, markers (of a motion), fixed, rigid, stiffness, rest (the "
      "shape before, "
      "faintly), ground, points (in place of splats or faces), energy or displacement (as colours); with commas");
  arguments.option("--color", "NAME", options->color,
                   "Numbers to show as colours: an attribute, or of an edit displacement, stretch, rotation or energy");
  arguments.option("--colormap", "MAP", options->colormap, "viridis (without), turbo or cool-warm, whose middle is 0");
  arguments.option("--range", "LOW,HIGH", options->range,
                   "Numbers at the ends of the colours; without, the 1st and the 99th percentile, or 0 and the latter");
  arguments.option("--turntable", "N", options->turntable, "N pictures once around the shape: name.0001.png ...");
  arguments.option("--cut", "AXIS=PART", options->cut,
                   "Of the tets only this part of their extent along an axis: z=0.5");
  arguments.option("--up", "AXIS", options->up, "y (without) or z: what is up in the picture");
  arguments.option("--point-size", "PIXELS", options->point_size, "Diameter of points; without, from their number");
  arguments.option("--from", "EXT", options->from, "Format of standard input, by an extension");
  arguments.flag("--force", options->force, "Replace PNG where it exists");
  return [options] { return run(*options); };
}

}  // namespace sinew::app
