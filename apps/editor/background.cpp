#include "apps/editor/background.h"

#include <chrono>
#include <exception>
#include <new>

#include "engine/geometry/check.h"
#include "engine/io/io.h"

namespace sinew::editor {

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string sentence_of_failure(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::bad_alloc&) {
    return "expected enough memory for this, found too little";
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

Background::~Background() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void Background::start(std::string what, bool can_cancel, Work work) {
  CHECK(!busy(), what_, what);
  what_ = std::move(what);
  can_cancel_ = can_cancel;
  started_ = seconds_now();
  fraction_ = -1;
  stop_ = false;
  thread_ = std::thread([this, work = std::move(work)] {
    double told = 0;
    const Tell tell = [&](double fraction) {
      fraction_ = fraction;
      // Waking a window for each thousandth would cost more than the work.
      if (const double time = seconds_now(); wake_ && time - told > 0.05) {
        told = time;
        wake_();
      }
      return !stop_;
    };
    Outcome outcome;
    outcome.error = sentence_of_failure([&] {
      try {
        outcome.finish = work(tell);
      } catch (const io::Cancelled&) {
        outcome.cancelled = true;
      }
    });
    outcome_.put(std::move(outcome));
    if (wake_) wake_();
  });
}

std::optional<Background::Outcome> Background::take() {
  std::optional<Outcome> outcome = outcome_.take();
  if (!outcome) return outcome;
  thread_.join();
  if (stop_ && can_cancel_) *outcome = {{}, true, {}};
  return outcome;
}

double Background::seconds() const {
  return seconds_now() - started_;
}

}  // namespace sinew::editor
