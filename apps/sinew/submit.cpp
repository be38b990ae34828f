/// The same command as many tasks, run by what runs the machines: Slurm, GNU parallel, or whoever takes the lines.

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "apps/sinew/child.h"
#include "apps/sinew/command.h"
#include "apps/sinew/files.h"
#include "apps/sinew/interrupt.h"
#include "apps/sinew/job_log.h"
#include "apps/sinew/progress.h"
#include "apps/sinew/task.h"
#include "engine/geometry/error.h"

namespace sinew::app {

namespace {

struct Options {
  std::string engine, tasks, jobs, log = "sinew-submit";
  bool resume = false, force = false;
  std::vector<std::string> command;
};

struct Engine {
  const char* name;
  const char* program;  ///< looked for in PATH
  const char* package;  ///< of Debian
  /// The command line that runs `tasks` in the folder of the log.
  std::vector<std::string> (*arguments)(const TaskNumbers& tasks, const std::string& jobs, const JobLog& log);
  void (*stop)(const Child& child, const JobLog& log);
  bool late;  ///< can be ended once all tasks have: it finds out seldom
};

void write_text(const JobLog& log, const char* name, const std::string& text) {
  write_output_text(log.path() + "/" + name, text, true);
}

// Both are started in the folder of the log, so that its path needs no quoting for either.

std::vector<std::string> slurm_arguments(const TaskNumbers& tasks, const std::string& jobs, const JobLog& log) {
  write_text(log, "array.sh",
             fmt::format("#!/bin/sh\n#SBATCH --job-name=sinew\nexec sh {} \"$SLURM_ARRAY_TASK_ID\"\n",
                         shell_quoted(log.path() + "/task.sh")));
  const std::string array = "--array=" + ranges_of(tasks, ",") + (jobs.empty() ? "" : "%" + jobs);
  return {"--parsable", "--wait", array, "--output=slurm.log", "--open-mode=append", "array.sh"};
}

/// Ends the job in the queue, which sbatch leaves there.
void stop_slurm(const Child& sbatch, const JobLog& log) {
  const std::string job = sbatch.output().substr(0, sbatch.output().find_first_of(";\n"));
  const std::string scancel = find_program("scancel");
  if (!job.empty() && !scancel.empty()) {
    const Child cancelling({scancel, job}, log.path());
  } else {
    sbatch.signal(SIGTERM);
  }
}

std::vector<std::string> parallel_arguments(const TaskNumbers&, const std::string& jobs, const JobLog& log) {
  // All tasks, always: those that its job log has as done are known by their place in the list.
  std::string numbers;
  for (std::uint64_t task = 1; task <= log.count(); ++task) numbers += std::to_string(task) + "\n";
  write_text(log, "numbers", numbers);
  std::vector<std::string> out{"--joblog", "joblog", "--resume-failed", "--arg-file", "numbers"};
  if (!jobs.empty()) out.insert(out.end(), {"--jobs", jobs});
  out.insert(out.end(), {"sh", "task.sh", "{}"});
  return out;
}

void stop_parallel(const Child& parallel, const JobLog&) {
  parallel.signal(SIGTERM);  // it ends its tasks first
}

constexpr Engine engines[] = {
    {"slurm", "sbatch", "slurm-client", slurm_arguments, stop_slurm, true},
    {"parallel", "parallel", "parallel", parallel_arguments, stop_parallel, false},
};

/// Null for print.
const Engine* engine_of(const Options& options) {
  for (const Engine& engine : engines)
    if (options.engine == engine.name) return &engine;
  if (options.engine != "print")
    throw UsageError("--engine: expected slurm, parallel or print, found " + sinew::quoted(options.engine));
  if (options.resume || options.force || !options.jobs.empty())
    throw UsageError("--engine print: expected --tasks alone, found an option of what runs tasks");
  return nullptr;
}

/// Bytes of the largest file that the command names.
std::uintmax_t largest_file(const std::vector<std::string>& command) {
  std::uintmax_t largest = 0;
  for (const std::string& word : command) {
    std::error_code none;
    if (std::filesystem::is_regular_file(word, none)) largest = std::max(largest, std::filesystem::file_size(word));
  }
  return largest;
}

/// Starting a task of Slurm costs seconds; a task should take longer than that.
std::uint64_t usual_count(const std::vector<std::string>& command) {
  constexpr std::uint64_t bytes = std::uint64_t{1} << 28, most = 1000, frames = 16;
  if (command.front() == "deform") return frames;
  return std::clamp<std::uint64_t>(largest_file(command) / bytes, 1, most);
}

Submission submission_of(const Options& options) {
  const std::vector<std::string>& command = options.command;
  if (command.front() != "deform" && command.front() != "apply")
    throw UsageError("expected deform or apply as the command to submit, found " + sinew::quoted(command.front()));
  for (const std::string& word : command) {
    if (word == "--task" || word.starts_with("--task="))
      throw UsageError("expected a command without --task, which submit adds, found " + sinew::quoted(word));
    if (word == "-") throw UsageError("expected files, which tasks can share, found -");
  }
  const auto number = [](const char* name, const std::string& text) {
    const auto found = parse_number(text, most_tasks);
    if (!found)
      throw UsageError(
          fmt::format("{}: expected a number from 1 to {}, found {}", name, most_tasks, sinew::quoted(text)));
    return *found;
  };
  if (!options.jobs.empty()) number("--jobs", options.jobs);
  return {options.engine, command, options.tasks.empty() ? usual_count(command) : number("--tasks", options.tasks),
          std::filesystem::read_symlink("/proc/self/exe").string(), std::filesystem::current_path().string()};
}

/// Until it ends, with progress; Ctrl-C stops the tasks first.
int wait_for(Child& child, const Engine& engine, const JobLog& log, std::size_t tasks) {
  const std::size_t before = log.count() - tasks;
  Progress progress(fmt::format("running {} tasks by {}", tasks, engine.name));
  double done = 0;
  for (int round = 0, stopped = 0;; ++round) {
    if (const auto status = child.ended()) return *status;
    if (round % 10 == 0) done = static_cast<double>(log.statuses().size() - before) / static_cast<double>(tasks);
    if (!progress(done) && stopped++ == 0) engine.stop(child, log);
    if (engine.late && done == 1) child.signal(SIGTERM);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

/// What became of the tasks, in words and as an exit status.
int outcome(const JobLog& log) {
  constexpr std::size_t most_lines = 5;
  const TaskNumbers failed = log.unfinished();
  if (failed.empty()) return Ok;
  const std::map<std::uint64_t, int> statuses = log.statuses();
  for (std::size_t i = 0; i < std::min(failed.size(), most_lines); ++i) {
    const auto status = statuses.find(failed[i]);
    const std::string words = log.last_words(failed[i]);
    message(fmt::format(
        "task {} of {} {}{}{}", failed[i], log.count(),
        status == statuses.end() ? "did not come to its end" : "ended with status " + std::to_string(status->second),
        words.empty() ? "" : ": ", words));
  }
  message(fmt::format("{} of {} tasks failed, {}; their messages are in {}; --resume runs them again", failed.size(),
                      log.count(), ranges_of(failed, ", "), log.path()));
  if (failed.size() < log.count()) return SomeFramesFailed;
  // One cause for all, such as a missing file, is told by its own status.
  const int first = statuses.empty() ? Failed : statuses.begin()->second;
  const bool same = statuses.size() == failed.size() &&
                    std::all_of(statuses.begin(), statuses.end(), [&](const auto& s) { return s.second == first; });
  return same && first <= NotConverged ? first : Failed;
}

int run_by(const Engine& engine, const Submission& submission, const Options& options) {
  const std::string program = find_program(engine.program);
  if (program.empty())
    throw std::runtime_error(
        fmt::format("--engine {}: expected {} in PATH, found none (Debian has it in the package {})", engine.name,
                    engine.program, engine.package));
  const JobLog log(options.log, submission, options.resume, options.force);
  const TaskNumbers tasks = log.unfinished();
  if (tasks.empty()) {
    message(fmt::format("all {} tasks have been run already", log.count()));
    return Ok;
  }
  log.forget(tasks);
  std::vector<std::string> arguments = engine.arguments(tasks, options.jobs, log);
  arguments.insert(arguments.begin(), program);
  const HoldInterrupts hold;
  Child child(arguments, log.path());
  const int status = wait_for(child, engine, log, tasks.size());
  if (interrupted()) {
    message(
        fmt::format("interrupted with {} of {} tasks left; --resume runs them", log.unfinished().size(), log.count()));
    return Interrupted;
  }
  if (status != 0 && log.statuses().size() == log.count() - tasks.size())
    throw std::runtime_error(
        fmt::format("--engine {}: expected {} to run the tasks, found that it ended with status {} "
                    "and none was run",
                    engine.name, engine.program, status));
  return outcome(log);
}

int run(const Options& options) {
  const Engine* engine = engine_of(options);
  const Submission submission = submission_of(options);
  if (engine != nullptr) return run_by(*engine, submission, options);
  for (std::uint64_t task = 1; task <= submission.count; ++task)
    fmt::print("cd {} && {}\n", shell_quoted(submission.folder),
               submission.line(fmt::format("{}/{}", task, submission.count)));
  return Ok;
}

}  // namespace

std::function<int()> declare_submit(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.option(
      "--engine", "NAME", options->engine,
      "slurm: a job array; parallel: GNU parallel on this machine; print: prints the commands, for any other "
      "farm",
      true);
  arguments.option("--tasks", "N", options->tasks,
                   "How many (default: one for each 256 MiB of the file to apply to, at most 1000; 16 of deform)");
  arguments.option("--jobs", "J", options->jobs, "Tasks at once at most (default: what the engine takes)");
  arguments.option(
      "--log", "DIR", options->log,
      "Folder for messages and exit statuses of the tasks, which all machines see (default: sinew-submit)");
  arguments.flag("--resume", options->resume,
                 "Run only those tasks of an earlier submit again that did not end with 0; those of deform need its "
                 "--force for frames that they had written");
  arguments.flag("--force", options->force, "Replace the log of an earlier submit");
  arguments.positionals("COMMAND", options->command, "deform or apply with all it takes, after --");
  return [options] { return run(*options); };
}

}  // namespace sinew::app
