#include "apps/sinew/job_log.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "apps/sinew/files.h"
#include "apps/sinew/interrupt.h"
#include "apps/sinew/task.h"
#include "engine/geometry/error.h"
#include "engine/io/bytes.h"
#include "engine/io/io.h"

namespace sinew::app {

namespace fs = std::filesystem;

std::string shell_quoted(const std::string& word) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string out = "'";
  for (const char c : word) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      out += c;
    }
  }
  return out + "'";
}

std::string ranges_of(const TaskNumbers& numbers, const char* separator) {
  std::string out;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    out += (out.empty() ? "" : separator) + std::to_string(numbers[i]);
    if (last > i) out += (last == i + 1 ? separator : "-") + std::to_string(numbers[last]);
    i = last + 1;
  }
  return out;
}

std::string Submission::line(const std::string& task) const {
  std::string out = shell_quoted(program);
  for (const std::string& word : command) out += " " + shell_quoted(word);
  return out + " --task " + task;
}

namespace {

/// What --resume has to find as it was.
std::string text_of_command(const Submission& submission) {
  std::string out = fmt::format("{} {} tasks in {}:", submission.engine, submission.count, submission.folder);
  for (const std::string& word : submission.command)
    if (word != "--force") out += " " + shell_quoted(word);
  return out + "\n";
}

std::string text_of_script(const Submission& submission, const std::string& log) {
  return fmt::format(
      "#!/bin/sh\n"
      "# Runs task $1 of {0} and keeps its messages and its exit status.\n"
      "log={1}\n"
      "cd {2} || exit 1\n"
      "{3} >\"$log/$1.log\" 2>&1 </dev/null\n"
      "status=$?\n"
      "echo \"$status\" >\"$log/$1.status\" || exit 1\n"
      "exit \"$status\"\n",
      submission.count, shell_quoted(log), shell_quoted(submission.folder),
      submission.line(fmt::format("\"$1/{}\"", submission.count)));
}

/// The number of a task by the name of its file; nothing where it is another file.
std::optional<std::uint64_t> task_of(const fs::path& file, const char* extension) {
  if (file.extension() != extension) return std::nullopt;
  return parse_number(file.stem().string(), most_tasks);
}

void remove_files_of_tasks(const std::string& folder) {
  std::vector<fs::path> old{fs::path(folder) / "joblog"};
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (task_of(entry.path(), ".log") || task_of(entry.path(), ".status")) old.push_back(entry.path());
  for (const fs::path& file : old) fs::remove(file);
}

}  // namespace

JobLog::JobLog(const std::string& path, const Submission& submission, bool resume, bool force)
    : path_(fs::absolute(path).lexically_normal().string()), count_(submission.count) {
  const Writing writing;
  const std::string record = (fs::path(path) / "command").string(), command = text_of_command(submission);
  std::error_code error;
  const bool begun = fs::exists(record, error);
  if (resume && !begun) throw file_error(path, "the log of what --resume goes on with", "none");
  if (resume && io::as_text(io::load_bytes(record)) != command)
    throw file_error(record, "engine, number of tasks, folder and command as they were begun", "others");
  if (begun && !resume && !force)
    throw file_error(path, "a folder for a new log",
                     "that of an earlier submit (--resume goes on with it, --force replaces it)");
  fs::create_directories(path_, error);
  if (error) throw file_error(path, "a folder that can be made", sinew::quoted(error.message()));
  if (begun && !resume) remove_files_of_tasks(path_);
  write_output_text((fs::path(path_) / "task.sh").string(), text_of_script(submission, path_), true);
  write_output_text((fs::path(path_) / "command").string(), command, true);
}

// The folder is listed, and no file asked for by its name: a network file system looks anew at a folder that is listed,
// but remembers for some seconds that a file was absent.
std::map<std::uint64_t, int> JobLog::statuses() const {
  std::map<std::uint64_t, int> out;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_)) {
    const auto task = task_of(entry.path(), ".status");
    int status = 0;
    if (task && *task <= count_ && std::ifstream(entry.path()) >> status) out[*task] = status;
  }
  return out;
}

TaskNumbers JobLog::unfinished() const {
  const std::map<std::uint64_t, int> ended = statuses();
  TaskNumbers out;
  for (std::uint64_t task = 1; task <= count_; ++task) {
    const auto found = ended.find(task);
    if (found == ended.end() || found->second != 0) out.push_back(task);
  }
  return out;
}

void JobLog::forget(const TaskNumbers& tasks) const {
  for (const std::uint64_t task : tasks) fs::remove(fs::path(path_) / (std::to_string(task) + ".status"));
}

std::string JobLog::last_words(std::uint64_t task) const {
  std::ifstream file(fs::path(path_) / (std::to_string(task) + ".log"));
  std::string last;
  for (std::string line; std::getline(file, line);)
    if (!line.empty()) last = line;
  return last.starts_with("sinew: ") ? last.substr(7) : last;
}

}  // namespace sinew::app
