#pragma once
/// Choosing: a box, a sphere or a range of an attribute that selects while it is changed, until it is confirmed or
/// given up. No step of history: a selection is none.

#include <variant>

#include "apps/editor/attribute_range.h"
#include "apps/editor/volume.h"

namespace sinew::editor {

struct Choosing {
  std::variant<Volume, AttributeRange> what;
  SelectMode mode = SelectMode::Replace;
  PointSet before;             ///< the selection when it began
  std::optional<Volume> held;  ///< as it was when the drag of its gizmo began
  bool sizing = false;         ///< the gizmo scales in place of moving

  Volume* volume() { return std::get_if<Volume>(&what); }
  const Volume* volume() const { return std::get_if<Volume>(&what); }
  AttributeRange* range() { return std::get_if<AttributeRange>(&what); }
};

class Session;
struct View;

/// A volume around the selection; where nothing is selected around `at`, without that in the middle of the shape. One
/// that is being chosen moves to `at`.
void choose_by_volume(Session& session, View& view, std::optional<Vec3> at = {});
/// What is chosen by now is given up for it.
void choose_by_attribute(Session& session, View& view, const std::string& name);

/// After any change of View::choosing: selects what it holds. It ends where another shape was opened.
void apply_choosing(Session& session, View& view);
void confirm_choosing(View& view);
void cancel_choosing(Session& session, View& view);  ///< the selection is again what it was

}  // namespace sinew::editor
