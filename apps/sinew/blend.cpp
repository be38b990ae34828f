#include <algorithm>
#include <charconv>
#include <cmath>

#include "apps/sinew/command.h"
#include "apps/sinew/deform.h"
#include "deformers/methods.h"
#include "engine/document/settings.h"
#include "engine/geometry/error.h"

namespace sinew::app {

namespace {

std::vector<std::optional<double>> weights_of(const std::string& text) {
  std::vector<std::optional<double>> out;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    double weight = 0;
    const auto [rest, error] = std::from_chars(text.data() + at, text.data() + end, weight);
    if (error != std::errc{} || rest != text.data() + end || !std::isfinite(weight))
      throw UsageError("--weights: expected numbers with commas between them, found " +
                       sinew::quoted(text.substr(at, end - at)));
    out.emplace_back(weight);
    at = end + 1;
  }
  return out;
}

/// A shell without handles: with all weights given, it takes the shape between the poses.
document::Project blend_of(const DeformOptions& options, const std::vector<std::string>& poses,
                           const std::string& weights, const std::string& of) {
  document::Project project;
  document::Layer& layer = project.layers.emplace_back();
  layer.method = "shell";
  layer.examples = poses;
  layer.example_weights = weights_of(weights);
  layer.examples_of = of;
  for (const std::string& setting : options.settings) document::set_from_text(setting, project, methods());
  document::check_layers(project.layers, methods());
  return project;
}

}  // namespace

std::function<int()> declare_blend(Arguments& arguments) {
  const auto options = std::make_shared<DeformOptions>();
  const auto poses = std::make_shared<std::vector<std::string>>();
  const auto weights = std::make_shared<std::string>(), of = std::make_shared<std::string>();
  arguments.positional("REST", options->input, "The shape at rest");
  arguments.positionals("POSE", *poses,
                        "Poses with its points and faces: files, folders of them, glTF with morph targets");
  arguments.option("-w,--weights", "A,B,...", *weights,
                   "How much of each pose: 0 none, 1 all, beyond that more; of those not given none", true);
  arguments.option("--of", "SHAPE", *of,
                   "What the poses are poses of, where that is not REST: how it changes is applied to REST");
  arguments.option("-o,--output", "OUT", options->out.path, "File to write; - with --to", true);
  arguments.options("--set", "NAME=VALUE", options->settings, "A setting of method shell (see sinew methods)");
  arguments.option("--report", "R.json", options->report, "Write figures of the solve");
  arguments.option("--pose", "P", options->pose, "Write the solved edit, for sinew apply");
  arguments.flag("--strict", options->strict, "Exit with 4 where it did not converge (the file is written)");
  arguments.flag("--force", options->out.force, "Replace outputs that exist");
  arguments.option("--from", "EXT", options->from, "Format of standard input, by an extension");
  arguments.option("--to", "EXT", options->out.as, "Format of standard output, by an extension");
  return [options, poses, weights, of] {
    return run_deform(*options, [&] { return blend_of(*options, *poses, *weights, *of); });
  };
}

}  // namespace sinew::app
