#pragma once
/// Progress on standard error, where that is a terminal: what is being done, how much of it, and the time left.

#include <chrono>
#include <string>

namespace sinew::app {

class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();  ///< leaves an empty line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// 0..1; a new `what` starts the time again. Returns false once Ctrl-C was pressed.
  bool operator()(double fraction);
  bool operator()(const std::string& what, double fraction);

 private:
  std::string what_;
  bool terminal_, shown_ = false;
  std::chrono::steady_clock::time_point begin_, last_;
};

}  // namespace sinew::app
