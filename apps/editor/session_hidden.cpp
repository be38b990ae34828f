#include "apps/editor/session.h"

namespace sinew::editor {

/// Finite, and not hidden.
PointSet Session::selectable() const {
  return hidden_.empty() ? finite_ : inverted(hidden_, finite_);
}

void Session::hide(const PointSet& points) {
  hidden_ = points;
  selection_ = intersected(selection_, selectable());
  selection_changed();
}

void Session::hide_selection() {
  if (has_input()) hide(combined(hidden_, selection_, SelectMode::Add));
}

void Session::hide_unselected() {
  if (has_input() && !selection_.empty()) hide(inverted(selection_, finite_));
}

void Session::show_hidden() {
  if (has_input()) hide(PointSet(input_->size()));
}

}  // namespace sinew::editor
