#include "apps/sinew/deform_frames.h"

#include <fmt/core.h>

#include <algorithm>
#include <condition_variable>
#include <limits>
#include <map>
#include <mutex>
#include <thread>

#include "apps/sinew/command.h"
#include "apps/sinew/interrupt.h"
#include "apps/sinew/progress.h"
#include "deformers/methods.h"
#include "engine/document/evaluate.h"
#include "engine/geometry/parallel.h"
#include "engine/io/frame_pattern.h"
#include "engine/io/io.h"
#include "engine/io/sequence.h"

namespace sinew::app {

namespace {

/// What became of a frame.
struct Outcome {
  int status = Ok;
  std::string failure;  ///< a sentence, where it was not written
  std::vector<document::LayerReport> reports;
  std::vector<std::size_t> layers;  ///< of each report
  std::vector<std::string> notes;   ///< of the reader
};

/// Frames on their way: handed out in order, their outcomes taken in as they come.
class Batch {
 public:
  Batch(const FramesWork& work, const document::Project& project, std::vector<int> frames, io::FrameWriter& writer,
        bool measure)
      : work_(work), project_(project), frames_(std::move(frames)), writer_(writer), measure_(measure) {}

  /// Bends all frames on `work_.jobs` threads; false where Ctrl-C stopped it.
  bool run() {
    const auto count = std::min<std::size_t>(static_cast<std::size_t>(work_.jobs), frames_.size());
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < count; ++t) threads.emplace_back([this] { bend_frames(); });
    {
      Progress progress("bending " + work_.input);
      std::unique_lock lock(mutex_);
      while (outcomes_.size() < frames_.size() && !stop_) {
        changed_.wait_for(lock, std::chrono::milliseconds(100));
        const double done = static_cast<double>(outcomes_.size()) / static_cast<double>(frames_.size());
        stop_ = stop_ || !progress(done);
      }
    }
    for (std::thread& thread : threads) thread.join();
    return !stop_;
  }

  const std::map<int, Outcome>& outcomes() const { return outcomes_; }

 private:
  void bend_frames() {
    document::Workspace workspace(work_.sequence, methods());
    for (;;) {
      int frame = 0;
      {
        const std::lock_guard lock(mutex_);
        if (stop_ || next_ == frames_.size()) return;
        frame = frames_[next_++];
      }
      Outcome outcome = bend(workspace, frame);
      const std::lock_guard lock(mutex_);
      if (outcome.status == Interrupted) return;
      // A frame that fails may have left the workspace in the middle of an update.
      if (!outcome.failure.empty()) workspace = document::Workspace(work_.sequence, methods());
      outcomes_[frame] = std::move(outcome);
      changed_.notify_one();
    }
  }

  /// The frame is the unit that fails by itself: its errors become its outcome, and the others go on.
  Outcome bend(document::Workspace& workspace, int frame) {
    Outcome out;
    document::EvaluateOptions options;
    options.measure = measure_;
    options.progress = [this](const char*, std::size_t, double) {
      const std::lock_guard lock(mutex_);
      return !stop_;
    };
    try {
      const document::Evaluation evaluation = document::evaluate(workspace, project_.layers, frame, options);
      out.reports = evaluation.reports;
      out.notes = workspace.input(frame)->notes;
      for (const document::LayerResult& layer : evaluation.layers) out.layers.push_back(layer.layer);
      for (std::size_t i = 0; i < out.reports.size(); ++i) {
        const SolveReport& solve = out.reports[i].solve;
        const std::string place = fmt::format("frame {}: layer {}: ", frame, out.layers[i] + 1);
        if (solve.status == Status::Failed) return {Failed, place + solve.message, {}, {}, {}};
        if (solve.status != Status::Converged && work_.strict) out.status = NotConverged;
      }
      writer_.write(frame, *evaluation.shape);
    } catch (const io::Cancelled&) {
      out.status = Interrupted;
    } catch (const InputError& error) {
      out = {BadInput, error.what(), {}, {}, {}};
    } catch (const std::bad_alloc&) {
      out = {Failed, fmt::format("frame {}: expected enough memory, found too little", frame), {}, {}, {}};
    }
    return out;
  }

  const FramesWork& work_;
  const document::Project& project_;
  std::vector<int> frames_;
  io::FrameWriter& writer_;
  bool measure_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t next_ = 0;
  bool stop_ = false;
  std::map<int, Outcome> outcomes_;
};

/// Frames to be written, of all tasks.
std::vector<int> wanted_frames(const FramesWork& work) {
  if (work.frames.empty()) return work.sequence->frames;
  std::vector<int> frames = io::parse_frames("--frames", work.frames);
  std::sort(frames.begin(), frames.end());
  // A still is the same at every frame: keys alone make it move.
  if (work.sequence->frames.size() == 1) return frames;
  return io::chosen_frames(*work.sequence, work.input, work.frames).frames;
}

/// Says what went wrong; each sentence once, since all frames may have the same.
int tell(const std::map<int, Outcome>& outcomes) {
  std::map<std::string, std::vector<int>> failures;
  std::size_t failed = 0;
  int status = Ok, worst = Ok;
  for (const auto& [frame, outcome] : outcomes) {
    if (!outcome.failure.empty()) {
      failures[outcome.failure].push_back(frame);
      worst = std::max(worst, outcome.status == Failed ? static_cast<int>(Failed) : outcome.status);
      ++failed;
    } else {
      status = std::max(status, outcome.status);
    }
  }
  for (const auto& [failure, frames] : failures) message(failure);
  if (failed == 0) return status;
  if (failed == outcomes.size()) return worst;
  std::vector<int> lost;
  for (const auto& [frame, outcome] : outcomes)
    if (!outcome.failure.empty()) lost.push_back(frame);
  message(fmt::format("expected all {} frames to be bent, found {} that failed: {}", outcomes.size(), failed,
                      io::frames_text(lost)));
  return SomeFramesFailed;
}

/// Notes of the reader and messages of the solves, each once.
void tell_notes(const std::string& input, const std::map<int, Outcome>& outcomes) {
  std::map<std::string, bool> told;
  for (const auto& [frame, outcome] : outcomes) {
    for (const std::string& note : outcome.notes)
      if (!std::exchange(told[note], true)) message(input + ": " + note);
    for (std::size_t i = 0; i < outcome.reports.size(); ++i) {
      const std::string place = fmt::format("layer {}: ", outcome.layers[i] + 1);
      std::vector<std::string> sentences = outcome.reports[i].notes;
      if (!outcome.reports[i].solve.message.empty()) sentences.push_back(outcome.reports[i].solve.message);
      for (const std::string& sentence : sentences)
        if (!std::exchange(told[place + sentence], true)) message(place + sentence);
    }
  }
}

/// Frames that a run seems to lack, by its smallest step.
void tell_gaps(const std::string& input, const std::vector<int>& frames) {
  int step = std::numeric_limits<int>::max();
  for (std::size_t i = 1; i < frames.size(); ++i) step = std::min(step, frames[i] - frames[i - 1]);
  std::vector<int> missing;
  for (std::size_t i = 1; i < frames.size(); ++i)
    for (int frame = frames[i - 1] + step; frame < frames[i] && missing.size() < 1000; frame += step)
      missing.push_back(frame);
  if (!missing.empty()) message(input + ": expected every frame, found none of " + io::frames_text(missing));
}

}  // namespace

int deform_frames(const FramesWork& work, const document::Project& project, document::Report* report) {
  io::FrameWriterOptions writing;
  writing.frames = wanted_frames(work);
  writing.rate = work.sequence->rate;
  writing.force = work.out.force;
  writing.as = work.out.as;
  writing.share = work.share;
  const HoldInterrupts hold;
  const std::unique_ptr<io::FrameWriter> writer = [&] {
    const Writing at_fault;
    return io::create_frames(work.out.path, writing);
  }();
  Batch batch(work, project, writing.own_frames(), *writer, report != nullptr);
  if (!batch.run()) return Interrupted;
  tell_gaps(work.input, work.sequence->frames);
  tell_notes(work.input, batch.outcomes());
  const int status = tell(batch.outcomes());
  const bool whole = status == Ok || status == NotConverged;
  if (whole) {
    const Writing at_fault;
    for (const std::string& lost : writer->commit().lost) message(work.out.path + ": " + lost);
  }
  if (report != nullptr) {
    for (const auto& [frame, outcome] : batch.outcomes())
      for (std::size_t i = 0; i < outcome.reports.size(); ++i) {
        if (i < report->layers.size())
          document::add_frame(report->layers[i], outcome.reports[i]);
        else
          report->layers.push_back(outcome.reports[i]);
      }
    report->input.frames = batch.outcomes().size();
  }
  return status;
}

}  // namespace sinew::app
