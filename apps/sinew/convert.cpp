#include "apps/sinew/command.h"
#include "apps/sinew/files.h"
#include "apps/sinew/frames.h"
#include "engine/io/sequence.h"

namespace sinew::app {

namespace {

struct Options {
  std::string in, from, frames;
  Output out;
};

int run(const Options& options) {
  check_output(options.out);
  const Sequence sequence = open_input(options.in, options.from, options.frames);
  const bool folder = options.out.path.ends_with('/');
  if (!folder && (sequence.frames.size() > 1 || io::names_frames(options.out.path, options.out.as))) {
    write_frames(options.out, sequence);
    return Ok;
  }
  if (sequence.frames.size() > 1)
    throw UsageError(options.out.path + ": expected the name of a file for " + std::to_string(sequence.frames.size()) +
                     " frames, found a folder");
  const std::shared_ptr<const Shape> shape = sequence.load(sequence.frames.front());
  check_folder(options.out, options.in, *shape);
  write_output(options.out, *shape);
  return Ok;
}

}  // namespace

std::function<int()> declare_convert(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.positional("IN", options->in, "File or run of files to read (run.####.obj); - with --from");
  arguments.positional("OUT", options->out.path,
                       "File or run of files to write; - with --to; a folder, ending in /, for a scan set");
  arguments.option("--from", "EXT", options->from, "Format of standard input, by an extension");
  arguments.option("--to", "EXT", options->out.as, "Format of standard output, by an extension");
  arguments.flag("--force", options->out.force, "Replace OUT where it exists");
  arguments.option("--frames", "FRAMES", options->frames, "Only these frames, like 1-10x2,15");
  return [options] { return run(*options); };
}

}  // namespace sinew::app
