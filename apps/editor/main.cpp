/// sinew-editor [FILE...]: the window.

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "apps/editor/editor.h"
#include "engine/geometry/error.h"

namespace {

bool set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != 0 && std::string(value) != "0";
}

/// build/samples/scan.ply beside build/bin, where scripts/run makes it.
std::string sample_beside(const char* program) {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path folder = (error ? std::filesystem::path(program) : self).parent_path();
  const std::filesystem::path sample = folder.parent_path() / "samples" / "scan.ply";
  return std::filesystem::is_regular_file(sample, error) ? sample.string() : "";
}

int run(const sinew::editor::EditorOptions& options) {
  std::shared_ptr<sinew::gpu::Messages> messages;
  {
    sinew::editor::Editor editor(options);
    messages = editor.messages();
    editor.run();
  }
  const std::vector<std::string> said = messages->take();
  for (const std::string& message : said) std::cerr << "sinew-editor: validation: " << message << '\n';
  return said.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  sinew::editor::EditorOptions options;
  CLI::App app("Bends anything that is made of points, in a window.", "sinew-editor");
  app.add_option("FILE", options.files, "a shape with its poses, edits (EDIT.json) or motions to open")->type_name("");
  app.add_option("--record", options.window.record, "writes mouse and keys there, for --play")->type_name("FILE");
  app.add_option("--play", options.window.play, "plays recorded mouse and keys")->type_name("FILE");
  app.add_option("--times", options.times, "writes there how long each picture of a drag took after its mouse event")
      ->type_name("FILE");
  std::string size;
  app.add_option("--size", size, "of the window, 1280x720 unless given")->type_name("WxH");
  app.set_version_flag("--version", std::string("sinew-editor ") + SINEW_VERSION);
  app.footer(
      "Examples:\n  sinew-editor scan.ply\n  sinew-editor scan.ply lift.json\n  sinew-editor horse.obj poses/\n\n"
      "Environment: SINEW_VALIDATION=1 checks the use of Vulkan; any message makes the exit status 1.\n"
      "Exit status: 0 ok, 1 failed, 2 usage.");
  try {
    app.parse(argc, argv);
    if (!size.empty() && std::sscanf(size.c_str(), "%dx%d", &options.window.width, &options.window.height) != 2)
      throw CLI::ValidationError("--size", "expected WIDTHxHEIGHT, found '" + size + "'");
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  options.validation = set("SINEW_VALIDATION");
  options.sample = sample_beside(argv[0]);
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::cerr << "sinew-editor: " << error.what() << '\n';
    return 1;
  }
}
