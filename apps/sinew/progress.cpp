#include "apps/sinew/progress.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "apps/sinew/interrupt.h"

namespace sinew::app {

using Clock = std::chrono::steady_clock;

Progress::Progress(std::string what)
    : what_(std::move(what)), terminal_(isatty(STDERR_FILENO) == 1), begin_(Clock::now()), last_(begin_) {}

Progress::~Progress() {
  if (shown_) fmt::print(stderr, "\r\033[K");
}

bool Progress::operator()(const std::string& what, double fraction) {
  if (what != what_) {
    what_ = what;
    begin_ = Clock::now();
  }
  return (*this)(fraction);
}

bool Progress::operator()(double fraction) {
  if (interrupted()) return false;
  const Clock::time_point now = Clock::now();
  if (!terminal_ || now - last_ < std::chrono::milliseconds(100)) return true;
  last_ = now;
  shown_ = true;
  const double spent = std::chrono::duration<double>(now - begin_).count();
  std::string line = what_;
  if (fraction > 0) line += fmt::format(" {:.0f} %", 100 * std::min(1.0, fraction));
  if (fraction > 0.02 && spent > 1) line += fmt::format(", {:.0f} s left", std::ceil(spent / fraction - spent));
  fmt::print(stderr, "\r\033[Ksinew: {}", line);
  return true;
}

}  // namespace sinew::app
