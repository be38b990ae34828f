#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "apps/sinew/command.h"
#include "apps/sinew/deform.h"
#include "apps/sinew/deform_frames.h"
#include "apps/sinew/files.h"
#include "apps/sinew/input_check.h"
#include "apps/sinew/progress.h"
#include "apps/sinew/task.h"
#include "deformers/methods.h"
#include "engine/document/edit.h"
#include "engine/document/evaluate.h"
#include "engine/document/markers.h"
#include "engine/document/pose_file.h"
#include "engine/document/settings.h"
#include "engine/geometry/parallel.h"
#include "engine/io/sequence.h"

namespace sinew::app {

namespace {

using Options = DeformOptions;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

document::Project edit_of(const Options& options) {
  document::Project project = document::read_edit(options.edit);
  for (const std::string& setting : options.settings) document::set_from_text(setting, project, methods());
  document::check_layers(project.layers, methods());
  return project;
}

/// Whether the command line speaks of frames, or a motion of the edit does.
bool many_frames(const Options& options, const document::Project& project) {
  const auto driven = [](const document::Layer& layer) { return layer.on && layer.markers; };
  return std::any_of(project.layers.begin(), project.layers.end(), driven) || !options.frames.empty() ||
         !options.task.empty() || io::names_frames(options.input, options.from) ||
         io::names_frames(options.out.path, options.out.as);
}

/// All outputs, before any work is done.
void check_outputs(const Options& options) {
  if (options.input == "-" && options.edit == "-")
    throw UsageError("expected one of INPUT and --edit to be -, found both");
  const int streams = (options.out.path == "-") + (options.report == "-") + (options.pose == "-");
  if (streams > 1) throw UsageError("expected one output to be -, found " + std::to_string(streams));
  if (!options.report.empty()) check_output_text(options.report, options.out.force);
  if (!options.pose.empty()) check_output_text(options.pose, options.out.force);
}

document::Evaluation solve(const std::shared_ptr<const Shape>& input, const document::Project& project, bool measure) {
  Progress progress("");
  const auto show = [&](const char* what, std::size_t layer, double fraction) {
    return progress(fmt::format("{} layer {}", what, layer + 1), fraction);
  };
  return document::evaluate(input, project.layers, methods(), {show, measure});
}

/// The worst of the layers: Failed, NotConverged or Ok; messages of the layers go to standard error.
int status_of(const document::Evaluation& evaluation, bool strict) {
  int status = Ok;
  for (std::size_t i = 0; i < evaluation.reports.size(); ++i) {
    const SolveReport& report = evaluation.reports[i].solve;
    const std::string place = fmt::format("layer {}", evaluation.layers[i].layer + 1);
    for (const std::string& note : evaluation.reports[i].notes) message(place + ": " + note);
    if (!report.message.empty()) message(place + ": " + report.message);
    if (report.status == Status::Failed) return Failed;
    if (report.status == Status::Converged || !strict) continue;
    message(fmt::format("{}: expected a solve that converges, found {} after {} iterations", place,
                        name_of(report.status), report.iterations));
    status = NotConverged;
  }
  return status;
}

/// The frames of a sequence; pose files are for one frame.
int run_frames(const Options& options, const document::Project& project, Clock::time_point begin) {
  if (!options.pose.empty())
    throw UsageError("--pose: expected one frame, found a sequence, whose pose changes from frame to frame");
  FramesWork work;
  work.input = options.input;
  work.from = options.from;
  const std::shared_ptr<const Sequence> input = open_input(options.input, options.from);
  work.sequence = std::make_shared<const Sequence>(document::with_frames_of_markers(*input, project.layers));
  work.frames = options.frames;
  work.out = options.out;
  work.strict = options.strict;
  const auto jobs = options.jobs.empty() ? std::optional<std::uint64_t>(static_cast<std::uint64_t>(thread_count()))
                                         : parse_number(options.jobs, 1024);
  if (!jobs) throw UsageError("--jobs: expected a whole number from 1 to 1024, found " + sinew::quoted(options.jobs));
  work.jobs = static_cast<int>(*jobs);
  if (!options.task.empty()) work.share = parse_task(options.task);
  document::Report report;
  report.read = seconds_since(begin);
  const int status = deform_frames(work, project, options.report.empty() ? nullptr : &report);
  if (!options.report.empty() && status != Interrupted) {
    const std::size_t frames = report.input.frames;
    report.input = document::report_of(*work.sequence->load(work.sequence->frames.front()));
    report.input.frames = frames;
    report.total = seconds_since(begin);
    write_output_text(options.report, report_text(report), options.out.force);
  }
  return status;
}

}  // namespace

int run_deform(const DeformOptions& options, const std::function<document::Project()>& edit) {
  const Clock::time_point begin = Clock::now();
  check_outputs(options);
  const document::Project project = edit();
  // One task, or some frames, need not read all of the input for it.
  const bool all = options.task.empty() && options.frames.empty();
  InputCheck check(options.input, all ? project.hashes.of : std::vector<std::string>{});
  if (many_frames(options, project)) {
    const int status = run_frames(options, project, begin);
    check.tell();
    return status;
  }
  check_output(options.out);
  document::Report report;
  const std::shared_ptr<const Shape> input = read_input(options.input, options.from);
  report.read = seconds_since(begin);
  check_folder(options.out, options.input, *input);
  const document::Evaluation evaluation = solve(input, project, !options.report.empty());
  const int status = status_of(evaluation, options.strict);
  check.tell();
  if (status == Failed) return Failed;

  const Clock::time_point write_begin = Clock::now();
  write_output(options.out, *evaluation.shape);
  report.write = seconds_since(write_begin);
  if (!options.pose.empty())
    write_output_text(options.pose, solved_edit_text(solved_edit(evaluation, project.layers)), options.out.force);
  if (!options.report.empty()) {
    report.total = seconds_since(begin);
    report.input = document::report_of(*input);
    report.layers = evaluation.reports;
    write_output_text(options.report, report_text(report), options.out.force);
  }
  return status;
}

std::function<int()> declare_deform(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.positional("INPUT", options->input,
                       "File to bend, the .conf of a scan set, or frames: name.####.obj, name.pc2; - with --from");
  arguments.option("-e,--edit", "EDIT.json", options->edit, "What to do: layers of handles and fixed points; may be -",
                   true);
  arguments.option(
      "-o,--output", "OUT", options->out.path,
      "File to write, or frames as above; - with --to; a folder, ending in /, takes a scan set as one file "
      "a scan",
      true);
  arguments.option("--frames", "FRAMES", options->frames, "Only these frames: 1-10, 1-48x2, 3,7,20-30");
  arguments.option("--jobs", "N", options->jobs, "Frames at a time; without, one a core");
  arguments.option("--task", "I/N", options->task,
                   "The I-th of N tasks that share the frames; all of them make the same "
                   "bytes as one run");
  arguments.options("--set", "NAME=VALUE", options->settings,
                    "A setting of every layer whose method has it, or of layer N: N.NAME=VALUE (see sinew methods)");
  arguments.option("--report", "R.json", options->report, "Write figures of the solve");
  arguments.option("--pose", "P", options->pose, "Write the solved edit, for sinew apply");
  arguments.flag("--strict", options->strict, "Exit with 4 where a layer did not converge (the files are written)");
  arguments.flag("--force", options->out.force, "Replace outputs that exist");
  arguments.option("--from", "EXT", options->from, "Format of standard input, by an extension");
  arguments.option("--to", "EXT", options->out.as, "Format of standard output, by an extension");
  return [options] { return run_deform(*options, [&] { return edit_of(*options); }); };
}

}  // namespace sinew::app
