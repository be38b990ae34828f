#pragma once
/// Runs the built programs as a user would.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

extern char** environ;

namespace sinew {

struct Outcome {
  int status = -1;  ///< exit status; 1000 + number where a signal ended it
  std::string out, err;
  long peak_kib = 0;  ///< most memory it had
};

/// A running program. Its standard input is a pipe that stays open until close_input().
class Program {
 public:
  explicit Program(const std::vector<std::string>& arguments, const std::string& name = "sinew") {
    int in[2], out[2], err[2];
    if (pipe2(in, O_CLOEXEC) != 0 || pipe2(out, O_CLOEXEC) != 0 || pipe2(err, O_CLOEXEC) != 0)
      ADD_FAILURE() << "no pipes";
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
    const std::string path = std::string(SINEW_BINARY_DIR) + "/bin/" + name;
    std::vector<std::string> texts{name};
    texts.insert(texts.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& text : texts) pointers.push_back(text.data());
    pointers.push_back(nullptr);
    if (posix_spawn(&pid_, path.c_str(), &actions, nullptr, pointers.data(), environ) != 0)
      ADD_FAILURE() << "no " << path;
    posix_spawn_file_actions_destroy(&actions);
    for (const int end : {in[0], out[1], err[1]}) close(end);
    input_ = in[1];
    readers_[0] = std::thread([this, end = out[0]] { read_all(end, outcome_.out); });
    readers_[1] = std::thread([this, end = err[0]] { read_all(end, outcome_.err); });
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program() {
    if (pid_ > 0) wait();
  }

  void write(const std::string& text) {
    std::signal(SIGPIPE, SIG_IGN);
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t wrote = ::write(input_, text.data() + done, text.size() - done);
      if (wrote < 0) return;  // the program has gone, which its status tells
      done += static_cast<std::size_t>(wrote);
    }
  }
  void close_input() {
    if (input_ >= 0) close(input_);
    input_ = -1;
  }
  void interrupt() const { kill(pid_, SIGINT); }

  Outcome wait() {
    close_input();
    int status = 0;
    rusage usage{};
    wait4(pid_, &status, 0, &usage);
    pid_ = -1;
    for (std::thread& reader : readers_) reader.join();
    outcome_.status = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    outcome_.peak_kib = usage.ru_maxrss;
    return outcome_;
  }

 private:
  static void read_all(int end, std::string& text) {
    char buffer[65536];
    for (ssize_t got; (got = ::read(end, buffer, sizeof(buffer))) > 0;)
      text.append(buffer, static_cast<std::size_t>(got));
    close(end);
  }

  pid_t pid_ = -1;
  int input_ = -1;
  Outcome outcome_;
  std::thread readers_[2];
};

inline Outcome run_sinew(const std::vector<std::string>& arguments, const std::string& input = "") {
  Program program(arguments);
  program.write(input);
  return program.wait();
}

inline std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void save(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace sinew
