#pragma once
/// History: undo and redo without limit, as snapshots of the Project with a label each. A copy of a Project shares its
/// big arrays, so a snapshot costs little.

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "engine/document/project.h"
#include "engine/geometry/check.h"

namespace sinew::document {

class History {
 public:
  /// `label` names how the first state came about ("Open").
  explicit History(Project project, std::string label = "Open") {
    states_.emplace_back(std::move(label), std::move(project));
  }

  const Project& present() const { return states_[present_].second; }

  /// A new state after the present one; what had been undone is forgotten. A state equal to the present one adds none.
  void commit(Project project, std::string label) {
    if (project == present()) return;
    states_.erase(states_.begin() + static_cast<std::ptrdiff_t>(present_) + 1, states_.end());
    states_.emplace_back(std::move(label), std::move(project));
    ++present_;
  }

  bool can_undo() const { return present_ > 0; }
  bool can_redo() const { return present_ + 1 < states_.size(); }
  /// False where there is nothing to undo or redo.
  bool undo() { return can_undo() ? (--present_, true) : false; }
  bool redo() { return can_redo() ? (++present_, true) : false; }

  /// For a history panel: states from the oldest, and which is present.
  std::size_t size() const { return states_.size(); }
  std::size_t position() const { return present_; }
  const std::string& label(std::size_t state) const { return states_[state].first; }
  void go_to(std::size_t state) {
    CHECK(state < states_.size(), state, states_.size());
    present_ = state;
  }

 private:
  std::vector<std::pair<std::string, Project>> states_;
  std::size_t present_ = 0;
};

}  // namespace sinew::document
