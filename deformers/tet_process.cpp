#include "deformers/tet_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "engine/geometry/error.h"

namespace sinew {

namespace {

using Clock = std::chrono::steady_clock;

/// SINEW_TETS, or sinew-tets beside this program, above it or in bin beside its folder.
std::string program_path() {
  if (const char* path = std::getenv("SINEW_TETS")) return path;
  std::error_code none;
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", none).parent_path();
  for (const char* near : {"sinew-tets", "../sinew-tets", "../bin/sinew-tets"})
    if (access((folder / near).c_str(), X_OK) == 0) return (folder / near).string();
  throw file_error((folder / "sinew-tets").string(), "the program that makes tets", "none");
}

/// A process whose standard input and output are ours; it and what it started are gone with this object.
class Process {
 public:
  Process(const std::string& path, const std::vector<std::string>& arguments) {
    int in[2], out[2];
    // A socket, because a write to one can be told not to raise SIGPIPE, whatever the rest of the program does with it.
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, in) != 0)
      throw file_error(path, "room for a socket", quoted(std::strerror(errno)));
    if (pipe2(out, O_CLOEXEC) != 0) {
      close(in[0]);
      close(in[1]);
      throw file_error(path, "room for a pipe", quoted(std::strerror(errno)));
    }
    in_ = in[0];
    out_ = out[0];
    fcntl(in_, F_SETFL, O_NONBLOCK);
    fcntl(out_, F_SETFL, O_NONBLOCK);
    const int error = spawn(path, arguments, in[1], out[1]);
    close(in[1]);
    close(out[1]);
    if (error == 0) return;
    close(in_);
    close(out_);
    throw file_error(path, "a program that starts", quoted(std::strerror(error)));
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    kill(-pid_, SIGKILL);  // before its number is free for others
    while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
    close_input();
    close(out_);
  }

  /// Waits up to 20 ms for something to happen, then writes and reads what is possible. False once it has ended and all
  /// was read.
  bool step(const std::string& input, std::string& output) {
    if (in_ >= 0 && written_ == input.size()) close_input();
    pollfd ends[2] = {{out_, POLLIN, 0}, {in_, POLLOUT, 0}};
    poll(ends, in_ >= 0 ? 2 : 1, open_ ? 20 : 0);
    if (!open_) usleep(2000);  // it closed its output and goes on
    if (in_ >= 0) {
      const ssize_t wrote = send(in_, input.data() + written_, input.size() - written_, MSG_NOSIGNAL);
      if (wrote > 0) written_ += static_cast<std::size_t>(wrote);
      if (wrote < 0 && errno != EAGAIN && errno != EINTR) close_input();  // it doesn't want to know; its end tells why
    }
    if (!ended_) look();
    char buffer[65536];
    const ssize_t got = read(out_, buffer, sizeof(buffer));
    if (got > 0) output.append(buffer, static_cast<std::size_t>(got));
    if (got == 0) open_ = false;
    return !ended_ || got > 0;
  }
  int code() const { return code_; }      ///< its exit status, -1 where a signal ended it
  int signal() const { return signal_; }  ///< that signal

 private:
  int spawn(const std::string& path, const std::vector<std::string>& arguments, int in, int out) {
    std::vector<std::string> texts{path};
    texts.insert(texts.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& text : texts) pointers.push_back(text.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t all, no;  // what is blocked or ignored here would be so there
    sigfillset(&all);
    sigemptyset(&no);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setsigmask(&attributes, &no);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
    const int error = posix_spawn(&pid_, path.c_str(), &actions, &attributes, pointers.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return error;
  }
  void look() {
    siginfo_t info{};
    if (waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == 0) return;
    ended_ = true;
    if (info.si_pid == 0) code_ = 0;  // where the program ignores SIGCHLD: what was read decides
    if (info.si_pid != 0) (info.si_code == CLD_EXITED ? code_ : signal_) = info.si_status;
  }
  void close_input() {
    if (in_ >= 0) close(in_);
    in_ = -1;
  }

  pid_t pid_ = -1;
  int in_ = -1, out_ = -1, code_ = -1, signal_ = 0;
  bool ended_ = false, open_ = true;
  std::size_t written_ = 0;
};

template <class T>
void append(std::string& text, const T* values, std::size_t count) {
  text.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

std::string request_text(tets::Job job, const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  tets::Request request;
  request.job = job;
  request.points = points.size();
  request.triangles = triangles.size();
  std::string text;
  append(text, &request, 1);
  append(text, points.data(), points.size());
  append(text, triangles.data(), triangles.size());
  return text;
}

InputError no_answer(const std::string& path, const std::string& found) {
  return file_error(path, "tets", found);
}

/// Bytes of the reply that begins so. Throws where it is none or is larger than `most`.
std::uint64_t reply_size(const std::string& path, const std::string& text, std::uint64_t most) {
  tets::Reply reply;
  std::memcpy(&reply, text.data(), sizeof(reply));
  if (reply.mark != tets::reply_mark) throw no_answer(path, "an answer that it does not give");
  if (reply.added > most / sizeof(Vec3) || reply.tets > most / sizeof(Tet) || reply.crossing > most / sizeof(Index))
    throw no_answer(path, "an answer longer than the memory it may use");
  return sizeof(reply) + reply.added * sizeof(Vec3) + reply.tets * (sizeof(Tet) + sizeof(Index)) +
         reply.crossing * sizeof(Index);
}

/// The reply, all of whose bytes are there.
TetAnswer answer_of(const std::string& path, const std::string& text, std::size_t points, std::size_t triangles) {
  tets::Reply reply;
  std::memcpy(&reply, text.data(), sizeof(reply));
  const char* from = text.data() + sizeof(reply);
  const auto take = [&from](auto& values, std::uint64_t count) {
    values.resize(count);
    const std::size_t bytes = count * sizeof(values[0]);
    if (count > 0) std::memcpy(static_cast<void*>(values.data()), from, bytes);
    from += bytes;
  };
  TetAnswer answer;
  take(answer.added, reply.added);
  take(answer.tets, reply.tets);
  take(answer.regions, reply.tets);
  take(answer.crossing, reply.crossing);
  for (const Vec3& point : answer.added)
    if (!point.allFinite()) throw no_answer(path, "a vertex that is not finite");
  for (std::size_t t = 0; t < answer.tets.size(); ++t)
    for (const Index corner : answer.tets[t])
      if (corner >= points + reply.added)
        throw no_answer(path, "vertex " + std::to_string(corner) + " in tet " + std::to_string(t) + " of " +
                                  std::to_string(points + reply.added) + " vertices");
  for (const Index triangle : answer.crossing)
    if (triangle >= triangles) throw no_answer(path, "triangle " + std::to_string(triangle) + " that it was not given");
  return answer;
}

InputError too_long(const TetLimits& limits) {
  return InputError("expected tets within " +
                    std::to_string(static_cast<int>(std::ceil(std::clamp(limits.seconds, 0.0, 1e6)))) +
                    " seconds, found none; fewer vertices take less time");
}

InputError too_large(const TetLimits& limits) {
  return InputError("expected tets within " + std::to_string(limits.bytes >> 20) +
                    " MiB of memory, found that more is needed; fewer vertices need less");
}

std::string signal_name(int number) {
  const char* name = sigabbrev_np(number);
  return name == nullptr ? std::to_string(number) : "SIG" + std::string(name);
}

}  // namespace

std::optional<TetAnswer> run_tets(tets::Job job, const std::vector<Vec3>& points,
                                  const std::vector<Triangle>& triangles, const TetLimits& limits,
                                  const std::function<bool(double)>& progress) {
  const double left = std::chrono::duration<double>(limits.end - Clock::now()).count();
  if (left <= 0) throw too_long(limits);
  const std::string path = program_path(), input = request_text(job, points, triangles);
  const auto cpu = static_cast<std::uint64_t>(std::min(std::ceil(left), 1e9) + 1);
  Process process(path, {std::to_string(limits.bytes), std::to_string(cpu)});
  const Clock::time_point begin = Clock::now();
  const double typical = 1e-4 + 2e-4 * static_cast<double>(triangles.size());  // seconds; only for what progress shows
  std::string output;
  while (process.step(input, output)) {
    if (output.size() >= sizeof(tets::Reply) && output.size() > reply_size(path, output, limits.bytes))
      throw no_answer(path, "an answer longer than it says");
    if (Clock::now() > limits.end) throw too_long(limits);
    const double spent = std::chrono::duration<double>(Clock::now() - begin).count();
    if (progress && !progress(1 - std::exp(-spent / typical))) return std::nullopt;
  }
  TetAnswer answer;
  const int code = process.code();
  if (process.signal() == SIGXCPU) throw too_long(limits);
  if (process.signal() == SIGKILL || code == tets::NoMemory)
    throw too_large(limits);  // as a system short of memory does
  if (code == tets::BadUse) throw no_answer(path, "a program that does not take what this one asks");
  if (code != tets::Done) {
    answer.how = code == tets::Crossing ? TetAnswer::How::Crossing : TetAnswer::How::Failed;
    answer.why = code == tets::Crossing ? "faces that touch or cross"
                 : code < 0             ? "that it was ended by " + signal_name(process.signal())
                 : code == tets::Failed ? "that TetGen gave up"
                                        : "that it ended with status " + std::to_string(code);
    return answer;
  }
  if (output.size() < sizeof(tets::Reply))
    throw no_answer(path, "an answer of " + std::to_string(output.size()) + " bytes");
  if (output.size() != reply_size(path, output, limits.bytes)) throw no_answer(path, "an answer that ends early");
  return answer_of(path, output, points.size(), triangles.size());
}

}  // namespace sinew
