#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "apps/sinew/command.h"

namespace sinew::app {

namespace {

class CliArguments : public Arguments {
 public:
  explicit CliArguments(CLI::App& app) : app_(app) {}
  void positional(const char* name, std::string& value, const char* help) override {
    app_.add_option(name, value, help)->required()->type_name("");
  }
  void positionals(const char* name, std::vector<std::string>& values, const char* help) override {
    app_.add_option(name, values, help)->required()->type_name("");
  }
  void option(const char* name, const char* type, std::string& value, const char* help, bool required) override {
    app_.add_option(name, value, help)->type_name(type)->required(required);
  }
  void options(const char* name, const char* type, std::vector<std::string>& values, const char* help) override {
    app_.add_option(name, values, help)->type_name(type)->allow_extra_args(false);
  }
  void flag(const char* name, bool& value, const char* help) override { app_.add_flag(name, value, help); }

 private:
  CLI::App& app_;
};

constexpr const char* footer =
    "Data goes to standard output, messages to standard error; - is standard input or output.\n"
    "Exit status: 0 ok, 1 failed, 2 usage, 3 bad input, 4 not converged under --strict,\n"
    "5 part of the frames failed, 130 interrupted.";

}  // namespace

int run_command_line(std::span<const Command> commands, int argc, char** argv) {
  CLI::App app("Bends anything that is made of points: scans, meshes, polygon soups.", "sinew");
  app.set_version_flag("--version", std::string("sinew ") + SINEW_VERSION);
  app.require_subcommand(1);
  app.footer(footer);
  std::function<int()> run;
  for (const Command& command : commands) {
    CLI::App* sub = app.add_subcommand(command.name, command.help);
    sub->footer(std::string("Examples:\n") + command.examples + "\n");
    CliArguments arguments(*sub);
    sub->callback([&run, body = command.declare(arguments)] { run = body; });
  }
  if (argc == 1) throw UsageError("expected a command, found none (see sinew --help)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help) == 0 ? Ok : Failed;
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    const std::string command = chosen.empty() ? "sinew" : "sinew " + chosen.front()->get_name();
    throw UsageError(fmt::format("{} (see {} --help)", error.what(), command));
  }
  return run();
}

}  // namespace sinew::app
