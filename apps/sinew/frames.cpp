#include "apps/sinew/frames.h"

#include <mutex>
#include <set>

#include "apps/sinew/interrupt.h"
#include "apps/sinew/progress.h"
#include "engine/io/sequence.h"

namespace sinew::app {

namespace {

/// Sentences that were told already.
struct Told {
  std::mutex mutex;
  std::set<std::string> sentences;
};

}  // namespace

Sequence open_input(const std::string& path, const std::string& as, const std::string& frames) {
  Sequence sequence;
  {
    Progress progress("reading " + path);
    io::ReadOptions options;
    options.progress = [&](double fraction) { return progress(fraction); };
    sequence = io::open_sequence(path, options, as);
  }
  if (!frames.empty()) sequence = io::chosen_frames(std::move(sequence), path, frames);
  sequence.load = [path, told = std::make_shared<Told>(), load = std::move(sequence.load)](int frame) {
    auto shape = load(frame);
    const std::scoped_lock lock(told->mutex);
    for (const std::string& note : shape->notes)
      if (told->sentences.insert(note).second) message(path + ": " + note);
    return shape;
  };
  return sequence;
}

void write_frames(const Output& output, const Sequence& sequence) {
  const HoldInterrupts hold;  // a file of many frames is open until the end
  Progress progress("writing " + output.path);
  io::FrameWriterOptions options;
  options.frames = sequence.frames;
  options.rate = sequence.rate;
  options.force = output.force;
  options.as = output.as;
  const auto writing = [](auto&& f) {
    const Writing guard;
    return f();
  };
  const auto writer = writing([&] { return io::create_frames(output.path, options); });
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    if (!progress(static_cast<double>(i) / static_cast<double>(sequence.frames.size()))) throw io::Cancelled();
    const auto shape = sequence.load(sequence.frames[i]);
    writing([&] { writer->write(sequence.frames[i], *shape); });
  }
  const io::WriteReport report = writing([&] { return writer->commit(); });
  for (const std::string& lost : report.lost) message(output.path + ": " + lost);
}

}  // namespace sinew::app
