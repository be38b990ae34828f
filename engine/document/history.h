#pragma once
/// History: undo and redo without limit, as snapshots of the Project with a label each. A copy of a Project shares its
/// big arrays, so a snapshot costs little.

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/document/project.h"
#include "engine/geometry/check.h"

namespace sinew::document {

class History {
 public:
  struct State {
    std::string label;  ///< how it came about: "Fix 120 points"
    Project project;
    std::uint64_t serial = 0;  ///< no other state of this history has or had it
  };

  /// `label` names how the first state came about ("Open").
  explicit History(Project project, std::string label = "Open") { add(std::move(project), std::move(label)); }
  /// From states that another history had, at least one, of which `present` is the present one.
  History(std::vector<State> states, std::size_t present) : states_(std::move(states)), present_(present) {
    CHECK(present < states_.size(), present, states_.size());
    for (State& state : states_) state.serial = serials_++;
  }

  const Project& present() const { return states_[present_].project; }

  /// A new state after the present one; what had been undone is forgotten. A state equal to the present one adds none.
  void commit(Project project, std::string label) {
    if (project == present()) return;
    states_.erase(states_.begin() + static_cast<std::ptrdiff_t>(present_) + 1, states_.end());
    add(std::move(project), std::move(label));
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
  const State& state(std::size_t state) const { return states_[state]; }
  const std::string& label(std::size_t state) const { return states_[state].label; }
  void go_to(std::size_t state) {
    CHECK(state < states_.size(), state, states_.size());
    present_ = state;
  }

 private:
  void add(Project project, std::string label) {
    states_.push_back({std::move(label), std::move(project), serials_++});
  }

  std::vector<State> states_;
  std::size_t present_ = 0;
  std::uint64_t serials_ = 0;
};

}  // namespace sinew::document
