#pragma once
/// Background: one thread at a time for work that must not hold up a frame: reading and writing files, finding
/// neighbours. It shares an atomic progress and a mailbox with the window's thread, nothing else.

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "engine/document/mailbox.h"

namespace sinew::editor {

/// Says 0..1 (below 0: unknown); false: stop as soon as can be, by returning or by throwing io::Cancelled.
using Tell = std::function<bool(double)>;

/// Of a clock that never goes back.
double seconds_now();

/// What went wrong in `work`, as a sentence; empty where nothing did. With the solver's thread the one place of the
/// editor where exceptions end.
std::string sentence_of_failure(const std::function<void()>& work);

class Background {
 public:
  /// What is to be done on the window's thread when the work is done.
  using Finish = std::function<void()>;
  using Work = std::function<Finish(const Tell&)>;
  struct Outcome {
    Finish finish;  ///< empty where it was cancelled or failed
    bool cancelled = false;
    std::string error;  ///< a sentence, or empty
  };

  /// `wake` is called from the work's thread when progress or outcome are to be looked at.
  explicit Background(std::function<void()> wake = {}) : wake_(std::move(wake)) {}
  /// Cancels and waits.
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  bool busy() const { return thread_.joinable(); }
  /// Only where it is not busy. An InputError or any std::exception of the work becomes Outcome::error.
  void start(std::string what, bool can_cancel, Work work);
  void cancel() { stop_ = true; }

  /// The outcome, once, after which it is no longer busy.
  std::optional<Outcome> take();

  const std::string& what() const { return what_; }
  double fraction() const { return fraction_; }
  bool can_cancel() const { return can_cancel_; }
  double seconds() const;  ///< since it started

 private:
  std::function<void()> wake_;
  std::string what_;
  bool can_cancel_ = false;
  double started_ = 0;
  std::atomic<double> fraction_ = -1;
  std::atomic<bool> stop_ = false;
  document::Mailbox<Outcome> outcome_;
  std::thread thread_;
};

}  // namespace sinew::editor
