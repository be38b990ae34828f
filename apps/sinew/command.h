#pragma once
/// A command of the program: one row of the table in main.cpp, one .cpp beside it.

#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace sinew::app {

/// Exit statuses (interface.md).
enum Exit { Ok = 0, Failed = 1, Usage = 2, BadInput = 3, NotConverged = 4, SomeFramesFailed = 5, Interrupted = 130 };

/// The command line asks for something that can't be.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What a command takes. The values must outlive the parsing; `name` of an option is "-o,--output", `type` what stands
/// for its value in the help.
class Arguments {
 public:
  virtual ~Arguments() = default;
  virtual void positional(const char* name, std::string& value, const char* help) = 0;
  virtual void positionals(const char* name, std::vector<std::string>& values, const char* help) = 0;
  virtual void option(const char* name, const char* type, std::string& value, const char* help,
                      bool required = false) = 0;
  /// May be given several times.
  virtual void options(const char* name, const char* type, std::vector<std::string>& values, const char* help) = 0;
  virtual void flag(const char* name, bool& value, const char* help) = 0;
};

struct Command {
  const char* name;
  const char* help;
  const char* examples;  ///< lines of the help
  /// Declares what it takes and returns what runs it (and gives an Exit).
  std::function<int()> (*declare)(Arguments&);
};

/// Parses the command line and runs the command it names; help and usage messages are printed here.
int run_command_line(std::span<const Command> commands, int argc, char** argv);

std::function<int()> declare_info(Arguments& arguments);
std::function<int()> declare_convert(Arguments& arguments);
std::function<int()> declare_diff(Arguments& arguments);
std::function<int()> declare_deform(Arguments& arguments);
std::function<int()> declare_blend(Arguments& arguments);
std::function<int()> declare_apply(Arguments& arguments);
std::function<int()> declare_submit(Arguments& arguments);
std::function<int()> declare_render(Arguments& arguments);
std::function<int()> declare_formats(Arguments& arguments);
std::function<int()> declare_methods(Arguments& arguments);

}  // namespace sinew::app
