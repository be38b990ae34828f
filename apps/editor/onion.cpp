#include "apps/editor/onion.h"

#include <algorithm>

#include "apps/editor/session.h"
#include "apps/editor/view.h"
#include "engine/document/evaluate.h"
#include "engine/io/io.h"

namespace sinew::editor {

std::vector<std::pair<int, int>> onion_frames(std::span<const int> frames, int frame, int count, int step) {
  std::vector<std::pair<int, int>> out;
  const auto found = std::lower_bound(frames.begin(), frames.end(), frame);
  const auto index = static_cast<int>(found - frames.begin()), n = static_cast<int>(frames.size());
  for (int away = 1; away <= count; ++away)
    for (const int side : {-1, 1})
      if (const int at = index + side * away * step; at >= 0 && at < n)
        out.emplace_back(side * away, frames[static_cast<std::size_t>(at)]);
  return out;
}

bool OnionSkin::poll() {
  std::optional<Background::Outcome> outcome = work_.take();
  if (outcome && outcome->finish) outcome->finish();
  return outcome.has_value();
}

bool OnionSkin::update(const Session& session, const View& view) {
  poll();
  const bool rests = view.show_onion && session.moves() && !session.solving() && !session.job();
  if (!rests) {
    if (work_.busy()) work_.cancel();
    begun_.reset();
    shown_.reset();
    found_.reset();
    return !std::exchange(ghosts_, {}).empty();
  }
  const Wanted wanted{session.sequence(), session.project(), session.frame(), view.onion_frames, view.onion_step};
  if (found_ && found_->wanted == wanted) {
    ghosts_ = std::move(found_->ghosts);
    shown_ = wanted;
    found_.reset();
    return true;
  }
  if (shown_ == wanted) return false;
  if (begun_ != wanted) {
    if (work_.busy())
      work_.cancel();
    else
      begin(session, wanted);
  }
  shown_.reset();
  return !std::exchange(ghosts_, {}).empty();
}

void OnionSkin::begin(const Session& session, const Wanted& wanted) {
  begun_ = wanted;
  found_.reset();
  if (workspace_of_ != wanted.sequence) {
    methods_.assign(session.methods().begin(), session.methods().end());
    workspace_ = std::make_shared<document::Workspace>(wanted.sequence, methods_);
    workspace_of_ = wanted.sequence;
  }
  work_.start("Onion skin", true, [this, wanted, workspace = workspace_](const Tell& tell) -> Background::Finish {
    auto found = std::make_shared<Found>();
    found->wanted = wanted;
    document::EvaluateOptions options;
    options.progress = [&](const char*, std::size_t, double) { return tell(-1); };
    for (const auto& [away, frame] : onion_frames(wanted.sequence->frames, wanted.frame, wanted.count, wanted.step)) {
      if (!tell(-1)) throw io::Cancelled{};
      found->ghosts.push_back(
          {frame, away, document::evaluate(*workspace, wanted.project.layers, frame, options).shape});
    }
    return [this, found] { found_ = std::move(*found); };
  });
}

}  // namespace sinew::editor
