#include "apps/editor/choosing.h"

#include "apps/editor/session.h"
#include "apps/editor/view.h"

namespace sinew::editor {

void choose_by_volume(Session& session, View& view, std::optional<Vec3> at) {
  if (!session.has_input()) return;
  Choosing* running = view.choosing ? &*view.choosing : nullptr;
  if (running != nullptr && running->volume() != nullptr) {
    if (at) running->volume()->centre = *at;
    apply_choosing(session, view);
    return;
  }
  cancel_choosing(session, view);
  const double diagonal = session.rest_bounds().diagonal();
  const PointSet& selection = session.selection();
  Bounds bounds;
  if (!selection.empty()) {
    bounds = session.selection_bounds();
  } else {
    const Vec3 middle = at ? *at : session.bent_bounds().centre();
    bounds.add(middle - Vec3::Constant(0.05 * diagonal));
    bounds.add(middle + Vec3::Constant(0.05 * diagonal));
  }
  Choosing choosing;
  choosing.what = volume_around(view.volume_kind, bounds, 1e-3 * diagonal);
  choosing.before = selection;
  view.choosing = std::move(choosing);
  apply_choosing(session, view);
}

void choose_by_attribute(Session& session, View& view, const std::string& name) {
  if (!session.has_input()) return;
  Choosing choosing;
  if (view.choosing && view.choosing->range() != nullptr) {
    choosing.before = view.choosing->before;  // another attribute, the same choice
    session.select(choosing.before, SelectMode::Replace);
    choosing.mode = view.choosing->mode;
  } else {
    cancel_choosing(session, view);
    choosing.before = session.selection();
  }
  choosing.what = range_of(*session.input(), name);
  view.choosing = std::move(choosing);
}

void apply_choosing(Session& session, View& view) {
  if (!view.choosing) return;
  Choosing& choosing = *view.choosing;
  if (!session.has_input() || choosing.before.size() != session.input()->size()) {
    view.choosing.reset();
    return;
  }
  if (Volume* volume = choosing.volume()) view.volume_kind = volume->kind;
  const PointSet touched = choosing.volume() != nullptr ? in_volume(session.bent_positions(), *choosing.volume())
                                                        : in_range(*choosing.range());
  session.select(combined(choosing.before, touched, choosing.mode), SelectMode::Replace);
}

void confirm_choosing(View& view) {
  view.choosing.reset();
}

void cancel_choosing(Session& session, View& view) {
  if (!view.choosing) return;
  const PointSet before = std::move(view.choosing->before);
  view.choosing.reset();
  session.select(before, SelectMode::Replace);
}

}  // namespace sinew::editor
