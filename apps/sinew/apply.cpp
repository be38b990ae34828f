#include <utility>

#include "apps/sinew/command.h"
#include "apps/sinew/files.h"
#include "apps/sinew/interrupt.h"
#include "apps/sinew/progress.h"
#include "apps/sinew/task.h"
#include "deformers/methods.h"
#include "engine/document/pose_file.h"
#include "engine/geometry/skin.h"
#include "engine/io/bytes.h"
#include "engine/io/stream.h"

namespace sinew::app {

namespace {

struct Options {
  std::string pose, input, from, task;
  Output out;
};

document::PoseApplier read_pose(const std::string& path, Vec3& origin) {
  const std::vector<std::byte> bytes = io::load_bytes(path);
  const document::SolvedEdit edit = document::parse_solved_edit(path, std::string(io::as_text(bytes)));
  origin = edit.origin;
  const Naming naming(path);
  return document::PoseApplier(edit, methods(), edit.origin);
}

int run(const Options& options) {
  if (options.pose == "-" && options.input == "-")
    throw UsageError("expected one of POSE and INPUT to be -, found both");
  io::StreamOptions stream;
  if (!options.task.empty()) stream.share = parse_task(options.task);
  if (!stream.share) check_output({options.out.path, options.from, options.out.force});
  const document::PoseApplier pose = read_pose(options.pose, stream.origin);
  stream.force = options.out.force;
  stream.as = options.from;
  io::WriteReport report;
  {
    const HoldInterrupts hold;
    Progress progress("bending " + options.input);
    bool told = false;
    stream.progress = [&](double fraction) { return progress(fraction); };
    report = io::stream(options.input, options.out.path, stream, [&](Shape& block) {
      if (!std::exchange(told, true))
        for (const std::string& left : not_bent(block)) message(options.input + ": " + left);
      block = pose.apply(block);
    });
  }
  for (const std::string& lost : report.lost) message(options.out.path + ": " + lost);
  return Ok;
}

}  // namespace

std::function<int()> declare_apply(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.positional("POSE", options->pose, "What sinew deform --pose wrote");
  arguments.positional("INPUT", options->input, "File to bend; - with --from");
  arguments.option("-o,--output", "OUT", options->out.path, "File to write; - with --from", true);
  arguments.option("--from", "EXT", options->from, "Format of standard input and output, by an extension");
  arguments.flag("--force", options->out.force, "Replace OUT where it exists");
  arguments.option("--task", "I/N", options->task,
                   "Bend the I-th of N shares of a large binary PLY and write it in place into OUT, which "
                   "all N share; complete once every one of them has left with 0");
  return [options] { return run(*options); };
}

}  // namespace sinew::app
