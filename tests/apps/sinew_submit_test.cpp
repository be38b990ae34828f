/// Tasks: apply --task, and what submit makes of a command. Slurm itself runs in tests/clients/farm.sh.

#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "tests/apps/program.h"
#include "tests/apps/sinew_fixtures.h"
#include "tests/io/temporary_folder.h"

namespace sinew {

namespace {

/// n points of a wavy sheet as a binary PLY.
std::string binary_sheet(int n) {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(n) +
                     "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar intensity\nend_header\n";
  for (int i = 0; i < n; ++i) {
    const float p[3] = {3.9f * static_cast<float>(i % 997) / 997, 1.9f * static_cast<float>(i % 463) / 463,
                        0.05f * static_cast<float>(i % 3)};
    text.append(reinterpret_cast<const char*>(p), sizeof(p));
    text += static_cast<char>(i % 256);
  }
  return text;
}

/// A folder, with a space in its name, with a pose, a scan and what one run makes of it.
struct Work {
  TemporaryFolder folder;
  std::string place = folder / "a b", pose, scan, out, wanted;

  Work() {
    std::filesystem::create_directory(place);
    pose = place + "/it's.pose", scan = place + "/scan.ply", out = place + "/out.ply";
    save(place + "/sheet.ply", sheet_ply());
    save(place + "/edit.json", turn_edit());
    save(scan, binary_sheet(3000));
    EXPECT_EQ(run_sinew({"deform", place + "/sheet.ply", "--edit", place + "/edit.json", "-o", place + "/bent.ply",
                         "--pose", pose})
                  .status,
              0);
    EXPECT_EQ(run_sinew({"apply", pose, scan, "-o", place + "/single.ply"}).status, 0);
    wanted = contents(place + "/single.ply");
    EXPECT_NE(wanted, contents(scan));
  }
  std::vector<std::string> submit(std::vector<std::string> options, std::vector<std::string> command) const {
    options.insert(options.begin(), "submit");
    options.push_back("--");
    options.insert(options.end(), command.begin(), command.end());
    return options;
  }
  std::vector<std::string> apply() const { return {"apply", pose, scan, "-o", out}; }
};

/// A program named `name` in a folder that is first in PATH while this lives.
class Stand {
 public:
  Stand(const std::string& folder, const std::string& name, const std::string& script) : before_(std::getenv("PATH")) {
    std::filesystem::create_directories(folder);
    save(folder + "/" + name, "#!/bin/sh\n" + script);
    std::filesystem::permissions(folder + "/" + name, std::filesystem::perms::owner_all);
    setenv("PATH", (folder + ":" + before_).c_str(), 1);
  }
  ~Stand() { setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

int shell(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) out.push_back(line);
  return out;
}

}  // namespace

TEST(SinewTask, SharesOfAnOutputAreOneRun) {
  const Work work;
  for (const int count : {1, 2, 3, 7, 64}) {
    std::filesystem::remove(work.out);
    for (int i = 0; i < count; ++i) {
      const int task = (i * 5 + 3) % count + 1;  // 5 divides none of the counts
      const std::string text = std::to_string(task) + "/" + std::to_string(count);
      const Outcome outcome = run_sinew({"apply", work.pose, work.scan, "-o", work.out, "--task", text});
      EXPECT_EQ(outcome.status, 0) << outcome.err;
    }
    EXPECT_TRUE(contents(work.out) == work.wanted) << count;
  }
}

TEST(SinewTask, WhatIsNoTaskIsRefused) {
  const Work work;
  for (const char* text :
       {"1", "/", "0/2", "3/2", "1/0", "-1/2", "1/2/3", "1/", "/2", "a/b", "1/1000001", "1 / 2", "0x1/2"}) {
    const Outcome outcome = run_sinew({"apply", work.pose, work.scan, "-o", work.out, "--task=" + std::string(text)});
    EXPECT_EQ(outcome.status, 2) << text;
    EXPECT_EQ(outcome.err,
              "sinew: --task: expected I/N, 1 <= I <= N <= 1000000, found \"" + std::string(text) + "\"\n");
  }
  EXPECT_FALSE(std::filesystem::exists(work.out));
  save(work.out, "old");
  const Outcome outcome = run_sinew({"apply", work.pose, work.scan, "-o", work.out, "--task", "1/2"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_NE(outcome.err.find("found another one of 3 bytes (--force replaces it)"), std::string::npos) << outcome.err;
  EXPECT_EQ(contents(work.out), "old");
}

TEST(SinewSubmit, PrintGivesLinesThatAShellRuns) {
  const Work work;
  const Outcome outcome = run_sinew(work.submit({"--engine", "print", "--tasks", "3"}, work.apply()));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const std::vector<std::string> lines = lines_of(outcome.out);
  ASSERT_EQ(lines.size(), 3u);
  const std::string program = std::filesystem::canonical(std::string(SINEW_BINARY_DIR) + "/bin/sinew").string();
  EXPECT_EQ(lines[1], "cd " + std::filesystem::current_path().string() + " && " + program + " apply '" + work.place +
                          "/it'\\''s.pose' '" + work.scan + "' -o '" + work.out + "' --task 2/3");
  for (const std::size_t i : {2u, 0u, 1u}) EXPECT_EQ(shell(lines[i]), 0) << lines[i];
  EXPECT_TRUE(contents(work.out) == work.wanted);
}

TEST(SinewSubmit, TheNumberOfTasksFollowsTheFile) {
  const Work work;
  const std::string big = work.place + "/big.ply";
  save(big, "");
  std::filesystem::resize_file(big, (std::uintmax_t{1} << 30) + 5);
  const auto count = [&](const std::vector<std::string>& command) {
    return lines_of(run_sinew(work.submit({"--engine", "print"}, command)).out).size();
  };
  EXPECT_EQ(count({"apply", work.pose, big, "-o", work.out}), 4u);
  EXPECT_EQ(count(work.apply()), 1u);
  EXPECT_EQ(count({"deform", "a.####.obj", "--edit", "e.json", "-o", "b.####.obj"}), 16u);
}

TEST(SinewSubmit, WhatCannotBeSubmittedIsRefused) {
  const Work work;
  const auto refused = [&](const std::vector<std::string>& options, const std::vector<std::string>& command) {
    const Outcome outcome = run_sinew(work.submit(options, command));
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    return outcome.err;
  };
  const std::vector<std::string> print{"--engine", "print", "--tasks", "2"};
  EXPECT_EQ(refused({"--engine", "pbs"}, work.apply()),
            "sinew: --engine: expected slurm, parallel or print, found \"pbs\"\n");
  EXPECT_EQ(refused(print, {"render", "a.ply"}),
            "sinew: expected deform or apply as the command to submit, found \"render\"\n");
  EXPECT_EQ(refused(print, {"apply", "p", "a.ply", "-o", "b.ply", "--task", "1/2"}),
            "sinew: expected a command without --task, which submit adds, found \"--task\"\n");
  EXPECT_EQ(refused(print, {"apply", "p", "-", "-o", "b.ply"}),
            "sinew: expected files, which tasks can share, found -\n");
  EXPECT_EQ(refused({"--engine", "print", "--tasks", "0"}, work.apply()),
            "sinew: --tasks: expected a number from 1 to 1000000, found \"0\"\n");
  EXPECT_EQ(refused({"--engine", "parallel", "--jobs", "two"}, work.apply()),
            "sinew: --jobs: expected a number from 1 to 1000000, found \"two\"\n");
  EXPECT_EQ(refused({"--engine", "print", "--resume"}, work.apply()),
            "sinew: --engine print: expected --tasks alone, found an option of what runs tasks\n");
  EXPECT_NE(refused({"--tasks", "2"}, work.apply()).find("--engine"), std::string::npos);
  EXPECT_NE(refused(print, {}).find("COMMAND"), std::string::npos);
}

TEST(SinewSubmit, AMissingEngineNamesItsPackage) {
  const Work work;
  const std::string before = std::getenv("PATH");
  setenv("PATH", work.place.c_str(), 1);
  const Outcome slurm = run_sinew(work.submit({"--engine", "slurm"}, work.apply()));
  const Outcome parallel = run_sinew(work.submit({"--engine", "parallel"}, work.apply()));
  setenv("PATH", before.c_str(), 1);
  EXPECT_EQ(slurm.status, 1);
  EXPECT_EQ(slurm.err,
            "sinew: --engine slurm: expected sbatch in PATH, found none (Debian has it in the package slurm-client)\n");
  EXPECT_EQ(parallel.status, 1);
  EXPECT_EQ(
      parallel.err,
      "sinew: --engine parallel: expected parallel in PATH, found none (Debian has it in the package parallel)\n");
}

// Programs that take the command lines of GNU parallel and Slurm and run the tasks one after the other.
constexpr const char* one_by_one =
    "for argument; do case $argument in --array=*) tasks=${argument#--array=} ;; esac; done\n"
    "if [ -n \"$tasks\" ]; then\n"
    "  printf '%s\\n' \"$@\" >arguments; echo 42; tasks=$(echo \"${tasks%%%*}\" | tr , ' ')\n"
    "else tasks=$(cat numbers); fi\n"
    "for task in $tasks; do\n"
    "  [ \"$task\" != \"$(cat kill 2>/dev/null)\" ] || continue\n"
    "  case $task in *-*) task=$(seq -s ' ' ${task%-*} ${task#*-}) ;; esac\n"
    "  for t in $task; do SLURM_ARRAY_TASK_ID=$t sh task.sh $t || failed=1; done\n"
    "done\n"
    "exit ${failed:-0}\n";

TEST(SinewSubmit, RunsTasksAndRunsThoseThatFailedAgain) {
  for (const std::string engine : {"slurm", "parallel"}) {
    const Work work;
    const Stand stand(work.folder / "bin", engine == "slurm" ? "sbatch" : engine, one_by_one);
    const std::string log = work.place + "/the log";
    const auto submit = [&](std::vector<std::string> more) {
      more.insert(more.end(), {"--engine", engine, "--tasks", "4", "--log", log});
      return run_sinew(work.submit(more, work.apply()));
    };
    std::filesystem::create_directory(log);
    save(log + "/kill", engine == "slurm" ? "1-4" : "3");
    const Outcome first = submit({"--jobs", "2"});
    if (engine == "slurm") {
      EXPECT_EQ(first.status, 1);
      EXPECT_NE(first.err.find("4 of 4 tasks failed, 1-4; "), std::string::npos) << first.err;
      EXPECT_NE(contents(log + "/arguments").find("--parsable\n--wait\n--array=1-4%2\n"), std::string::npos);
      save(log + "/1.status", "0\n");
      save(log + "/3.status", "0\n");
      EXPECT_EQ(run_sinew({"apply", work.pose, work.scan, "-o", work.out, "--task", "1/4"}).status, 0);
      EXPECT_EQ(run_sinew({"apply", work.pose, work.scan, "-o", work.out, "--task", "3/4"}).status, 0);
    } else {
      EXPECT_EQ(first.status, 5);
      EXPECT_EQ(first.err,
                "sinew: task 3 of 4 did not come to its end\nsinew: 1 of 4 tasks failed, 3; their messages "
                "are in " +
                    log + "; --resume runs them again\n");
    }
    EXPECT_FALSE(contents(work.out) == work.wanted);
    std::filesystem::remove(log + "/kill");

    const Outcome again = submit({});
    EXPECT_EQ(again.status, 1);
    EXPECT_EQ(again.err, "sinew: " + log +
                             ": expected a folder for a new log, found that of an earlier submit (--resume "
                             "goes on with it, --force replaces it)\n");
    const Outcome second = submit({"--resume"});
    EXPECT_EQ(second.status, 0) << second.err;
    EXPECT_TRUE(contents(work.out) == work.wanted) << engine;
    if (engine == "slurm") {
      EXPECT_NE(contents(log + "/arguments").find("--array=2,4\n"), std::string::npos);
    }
    const Outcome third = submit({"--resume"});
    EXPECT_EQ(third.status, 0);
    EXPECT_EQ(third.err, "sinew: all 4 tasks have been run already\n");
    EXPECT_EQ(submit({"--force"}).status, 0);
  }
}

TEST(SinewSubmit, OneCauseForAllHasItsOwnStatus) {
  const Work work;
  const Stand stand(work.folder / "bin", "parallel", one_by_one);
  const std::string log = work.place + "/log";
  const auto submit = [&](const std::string& scan, std::vector<std::string> more) {
    more.insert(more.end(), {"--engine", "parallel", "--tasks", "2", "--log", log});
    return run_sinew(work.submit(more, {"apply", work.pose, scan, "-o", work.out}));
  };
  const Outcome missing = submit(work.place + "/none.ply", {});
  EXPECT_EQ(missing.status, 3);
  EXPECT_TRUE(missing.err.starts_with("sinew: task 1 of 2 ended with status 3: " + work.place +
                                      "/none.ply: expected a file that can be read, found "))
      << missing.err;
  EXPECT_NE(missing.err.find("2 of 2 tasks failed, 1, 2; "), std::string::npos) << missing.err;
  const Outcome other = submit(work.scan, {"--resume"});
  EXPECT_EQ(other.status, 1);
  EXPECT_EQ(other.err, "sinew: " + log +
                           "/command: expected engine, number of tasks, folder and command as they were "
                           "begun, found others\n");
  EXPECT_EQ(submit(work.scan, {"--force"}).status, 0);
  EXPECT_TRUE(contents(work.out) == work.wanted);
  std::filesystem::remove_all(log);
  EXPECT_EQ(submit(work.scan, {"--resume"}).err,
            "sinew: " + log + ": expected the log of what --resume goes on with, found none\n");
}

TEST(SinewSubmit, AnEngineThatRefusesIsNamed) {
  const Work work;
  const Stand stand(work.folder / "bin", "sbatch", "echo 'sbatch: error: no such partition' >&2\nexit 1\n");
  const Outcome outcome =
      run_sinew(work.submit({"--engine", "slurm", "--tasks", "2", "--log", work.place + "/log"}, work.apply()));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err,
            "sbatch: error: no such partition\nsinew: --engine slurm: expected sbatch to run the tasks, found that it "
            "ended with status 1 and none was run\n");
}

TEST(SinewSubmit, CtrlCStopsTheTasks) {
  const Work work;
  const std::string bin = work.folder / "bin", log = work.place + "/log";
  const Stand sbatch(bin, "sbatch", "echo '42;cluster'\nwhile [ ! -f cancelled ]; do sleep 0.05; done\nexit 1\n");
  const Stand scancel(bin, "scancel", "echo \"$*\" >cancelled\n");
  Program program(work.submit({"--engine", "slurm", "--tasks", "2", "--log", log}, work.apply()));
  for (int i = 0; i < 200 && !std::filesystem::exists(log + "/array.sh"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  program.interrupt();
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.status, 130);
  EXPECT_EQ(outcome.err, "sinew: interrupted with 2 of 2 tasks left; --resume runs them\n");
  EXPECT_EQ(contents(log + "/cancelled"), "42\n");
}

}  // namespace sinew
