#pragma once
/// The folder in which the tasks of one submission leave their messages and exit statuses, for whatever runs them:
///
///   command    what was submitted
///   task.sh    runs task $1
///   7.log      what task 7 said
///   7.status   with which exit status it ended; absent where it was killed with its shell, or has not run

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace sinew::app {

using TaskNumbers = std::vector<std::uint64_t>;

/// `word` as a shell reads it back; words of plain characters are left as they are.
std::string shell_quoted(const std::string& word);

/// "2,5-7", with `separator` for the comma.
std::string ranges_of(const TaskNumbers& numbers, const char* separator);

/// A command that is run as tasks 1..count by the end "--task I/COUNT".
struct Submission {
  std::string engine;
  std::vector<std::string> command;  ///< without the program
  std::uint64_t count = 1;
  std::string program;  ///< path of sinew
  std::string folder;   ///< in which the command is run

  /// A shell's command line; `task` as the shell is to read it.
  std::string line(const std::string& task) const;
};

class JobLog {
 public:
  /// Makes the folder. One that holds another submission is refused: with `resume` it must hold this one (--force in
  /// the command may differ), with `force` its files are removed. Throws InputError.
  JobLog(const std::string& path, const Submission& submission, bool resume, bool force);

  const std::string& path() const { return path_; }  ///< absolute
  std::uint64_t count() const { return count_; }     ///< of the tasks
  /// Tasks that have ended, with their exit statuses.
  std::map<std::uint64_t, int> statuses() const;
  /// All that have not ended with 0.
  TaskNumbers unfinished() const;
  /// Before tasks are run again.
  void forget(const TaskNumbers& tasks) const;
  /// The last line that a task said, without "sinew: ".
  std::string last_words(std::uint64_t task) const;

 private:
  std::string path_;
  std::uint64_t count_;
};

}  // namespace sinew::app
