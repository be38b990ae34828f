#pragma once
/// SolverThread: one thread that takes the newest Project and gives back the newest poses. Two one-slot mailboxes are
/// all that it shares with the caller; what it publishes is never changed afterwards. While a mouse drags, each request
/// asks for Quality::Interactive, and the last one, when the button is let go, for Quality::Final.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "engine/document/mailbox.h"
#include "engine/document/project.h"
#include "engine/document/workspace.h"

namespace sinew::document {

struct SolveRequest {
  std::uint64_t ticket = 0;  ///< the caller's; comes back in the answers
  std::shared_ptr<const Sequence> input;
  int frame = 1;  ///< of the input, to be solved for
  std::vector<Layer> layers;
  SolveOptions::Quality quality = SolveOptions::Quality::Final;
};

struct SolveAnswer {
  std::uint64_t ticket = 0;
  std::shared_ptr<const Sequence> input;  ///< that the results belong to
  std::shared_ptr<const Shape> shape;     ///< its frame
  int frame = 1;
  std::vector<LayerResult> layers;  ///< so far; where `error` is set, none
  bool finished = false;            ///< false: an iteration of a solve that goes on
  bool final_quality = false;       ///< finished, and asked for with Quality::Final
  std::string error;                ///< a sentence, or empty
};

class SolverThread {
 public:
  /// `methods` must outlive the thread. `notify` is called on the solver's thread after each answer
  /// and when it has nothing to do any more (to wake a window).
  explicit SolverThread(std::span<const Method> methods, std::function<void()> notify = {});
  /// Stops a running solve at its next iteration, and joins.
  ~SolverThread();
  SolverThread(const SolverThread&) = delete;
  SolverThread& operator=(const SolverThread&) = delete;

  /// Replaces a request that has not begun. A running solve publishes what it has and stops at its next iteration; the
  /// building of a deformer goes on unless the new request would build another.
  void ask(SolveRequest request);

  /// The newest answer since the last call, if there is one.
  std::optional<SolveAnswer> answer() { return answers_.take(); }

  /// Stops what is running, to no result; the thread waits for the next request.
  void cancel();

  bool busy() const { return busy_; }
  /// Of the deformer that is being built, 0..1; 1 while none is.
  double building() const { return building_; }

 private:
  void run();
  void serve(const SolveRequest& request);
  SolveAnswer solve(const SolveRequest& request);
  void publish(SolveAnswer answer);

  std::span<const Method> methods_;
  std::function<void()> notify_;
  Mailbox<SolveRequest> requests_;
  Mailbox<SolveAnswer> answers_;
  std::atomic<bool> busy_ = false;
  std::atomic<double> building_ = 1;
  std::shared_ptr<const Sequence> input_;  ///< of the workspace
  std::unique_ptr<Workspace> workspace_;   ///< of the solver's thread alone
  std::thread thread_;                     ///< last: it uses all of the above
};

}  // namespace sinew::document
