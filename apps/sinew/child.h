#pragma once
/// A program that runs beside this one: looked for in PATH, started in a folder, asked now and then whether it has
/// ended.

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace sinew::app {

/// Where a shell finds the program; empty where it does not.
std::string find_program(const std::string& name);

class Child {
 public:
  /// Starts arguments[0], a path, in `folder` without standard input; its messages go where ours go. Throws
  /// std::runtime_error where it cannot be started.
  Child(const std::vector<std::string>& arguments, const std::string& folder);
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();  ///< waits for its end

  /// Its exit status, or 128 and the number of the signal that ended it, once it has ended.
  std::optional<int> ended();
  void signal(int number) const;
  /// What it has written to standard output up to the last call of ended().
  const std::string& output() const { return output_; }

 private:
  void read_output();

  pid_t pid_ = -1;
  int pipe_ = -1;
  std::optional<int> status_;
  std::string output_;
};

}  // namespace sinew::app
