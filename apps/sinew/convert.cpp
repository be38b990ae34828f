#include "apps/sinew/command.h"
#include "apps/sinew/files.h"

namespace sinew::app {

namespace {

struct Options {
  std::string in, from;
  Output out;
};

}  // namespace

std::function<int()> declare_convert(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.positional("IN", options->in, "File to read; - with --from");
  arguments.positional("OUT", options->out.path, "File to write; - with --to; a folder, ending in /, for a scan set");
  arguments.option("--from", "EXT", options->from, "Format of standard input, by an extension");
  arguments.option("--to", "EXT", options->out.as, "Format of standard output, by an extension");
  arguments.flag("--force", options->out.force, "Replace OUT where it exists");
  return [options] {
    check_output(options->out);
    const std::shared_ptr<const Shape> shape = read_input(options->in, options->from);
    check_folder(options->out, options->in, *shape);
    write_output(options->out, *shape);
    return Ok;
  };
}

}  // namespace sinew::app
