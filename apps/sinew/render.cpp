#include <fmt/core.h>

#include <algorithm>
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
#include "engine/io/text.h"

namespace sinew::app {

namespace {

struct Options {
  std::string input, from, png, edit, frame, size = "1280x720", view = "iso", show, up = "y", point_size, cut;
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

void check_fields(const std::set<std::string>& show, bool has_edit) {
  const bool energy = show.contains("energy"), displacement = show.contains("displacement");
  if (energy && displacement) throw UsageError("--show: expected energy or displacement, found both");
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

gpu::Picture draw(const Shape& input, const document::Evaluation* evaluation, const View& view,
                  const std::set<std::string>& show) {
  const std::unique_ptr<gpu::Device> device = gpu::create_device({});
  const gpu::Paths paths = gpu::measure_paths(*device);
  const gpu::RendererHandle renderer = gpu::create_renderer(*device, paths, gpu::offscreen_format);
  const gpu::Offscreen offscreen =
      gpu::create_offscreen(*device, {static_cast<std::uint32_t>(view.width), static_cast<std::uint32_t>(view.height)});
  DrawnShape drawn;
  fill_scene(*device, input, evaluation, view, show, drawn);
  gpu::Picture picture = gpu::render_picture(*device, *renderer, offscreen, drawn.scene);
  if (drawn.field) {
    draw_legend(picture, *drawn.field);
    message(fmt::format("{}: colours from 0 to {:.4g}; the most is {:.4g}", drawn.field->name, drawn.field->high,
                        drawn.field->most));
  }
  return picture;
}

int run(const Options& options) {
  View view = view_of(options);
  const std::set<std::string> show = shown(options.show);
  check_fields(show, !options.edit.empty());
  if (!options.png.ends_with(".png")) throw UsageError(options.png + ": expected a name that ends in .png");
  check_output_text(options.png, options.force);
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
  const gpu::Picture picture = draw(*input, evaluation ? &*evaluation : nullptr, view, show);
  const Writing writing;
  gpu::write_png(options.png, picture);
  return Ok;
}

}  // namespace

std::function<int()> declare_render(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.positional("INPUT", options->input, "File to draw, or frames: name.####.obj; - with --from");
  arguments.option("-o,--output", "PNG", options->png, "Picture to write", true);
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
  arguments.option("--cut", "AXIS=PART", options->cut,
                   "Of the tets only this part of their extent along an axis: z=0.5");
  arguments.option("--up", "AXIS", options->up, "y (without) or z: what is up in the picture");
  arguments.option("--point-size", "PIXELS", options->point_size, "Diameter of points; without, from their number");
  arguments.option("--from", "EXT", options->from, "Format of standard input, by an extension");
  arguments.flag("--force", options->force, "Replace PNG where it exists");
  return [options] { return run(*options); };
}

}  // namespace sinew::app
