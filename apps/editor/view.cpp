#include "apps/editor/view.h"

#include <algorithm>

#include "apps/editor/session.h"
#include "engine/gpu/scene.h"

namespace sinew::editor {

GizmoKind gizmo_kind(Tool tool) {
  return tool == Tool::Rotate ? GizmoKind::Rotate : tool == Tool::Scale ? GizmoKind::Scale : GizmoKind::Translate;
}

std::optional<Gizmo> gizmo_of(Session& session, const View& view) {
  if (view.choosing && view.choosing->volume() != nullptr)
    return Gizmo{view.choosing->sizing ? GizmoKind::Scale : GizmoKind::Translate, view.choosing->volume()->centre};
  const std::optional<std::size_t> handle = session.chosen_handle();
  if (!handle) return std::nullopt;
  const HandleView chosen = session.handles()[*handle];
  Gizmo gizmo;
  gizmo.kind = gizmo_kind(view.tool);
  gizmo.centre = chosen.target;
  if (view.space == Space::Local) gizmo.axes = chosen.axes;
  return gizmo;
}

bool begin_manipulation(Session& session, View& view, GizmoKind kind, GizmoPart part, bool modal) {
  std::optional<Gizmo> gizmo = gizmo_of(session, view);
  if (!gizmo) return false;
  if (view.choosing && view.choosing->volume() != nullptr)
    view.choosing->held = *view.choosing->volume();
  else if (!session.begin_drag(*session.chosen_handle()))
    return false;
  gizmo->kind = kind;
  view.manipulation.emplace(*gizmo, part, view.mouse, snap_length(session));
  view.modal = modal;
  return true;
}

void update_manipulation(Session& session, View& view, int modifiers) {
  if (!view.manipulation) return;
  if (!session.dragging() &&
      !(view.choosing && view.choosing->held)) {  // something else ended the drag: undo, another file
    view.manipulation.reset();
    return;
  }
  Manipulation& manipulation = *view.manipulation;
  manipulation.move_mouse(view.mouse, view.camera, view.size, modifiers);
  follow_manipulation(session, view);
}

static void follow_volume(Session& session, View& view) {
  Choosing& choosing = *view.choosing;
  *choosing.volume() = transformed(*choosing.held, view.manipulation->motion());
  if (view.manipulation->state() != Manipulation::State::Running) {
    choosing.held.reset();
    view.manipulation.reset();
  }
  apply_choosing(session, view);
}

void follow_manipulation(Session& session, View& view) {
  if (!view.manipulation) return;
  if (view.choosing && view.choosing->held) {
    follow_volume(session, view);
    return;
  }
  const Manipulation::State state = view.manipulation->state();
  if (state == Manipulation::State::Cancelled) {
    session.cancel_drag();
  } else {
    session.drag_to(view.manipulation->motion());
    if (state == Manipulation::State::Confirmed) session.end_drag();
  }
  if (state != Manipulation::State::Running) view.manipulation.reset();
}

double snap_length(const Session& session) {
  return gpu::ground_below(session.rest_bounds(), gpu::UpAxis::Y).cell / 10;
}

void glide_to(View& view, const gpu::Camera& camera) {
  view.glide = CameraGlide(view.camera, camera, view.up);
}

}  // namespace sinew::editor
