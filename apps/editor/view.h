#pragma once
/// View: what the window shows of a session and what the mouse does in it, as plain data: a camera, the tool in hand,
/// the switches of the tool bar. No part of a project.

#include <optional>
#include <string>

#include "apps/editor/choosing.h"
#include "apps/editor/manipulation.h"
#include "apps/editor/navigation.h"
#include "apps/editor/tools.h"
#include "engine/document/field.h"
#include "engine/gpu/colormap.h"
#include "engine/gpu/solid.h"

namespace sinew::editor {

/// Click is part of all of them: a press and release on one place.
enum class Tool { Select, Move, Rotate, Scale, Box, Lasso, Polygon, Brush, Ball, Volume, Cut };
enum class Space { World, Local };

struct View {
  gpu::Camera camera;
  gpu::UpAxis up = gpu::UpAxis::Y;
  CameraGlide glide;
  Eigen::Vector2d size{1280, 720};  ///< of the picture, pixels
  Eigen::Vector2d mouse{0, 0};      ///< pixels

  Tool tool = Tool::Box;
  Depth depth = Depth::VisibleOnly;
  Space space = Space::World;
  double brush_radius = 24;  ///< pixels
  double ball_radius = 0.1;  ///< of the sphere brush, in the shape's unit
  Volume::Kind volume_kind = Volume::Kind::Box;

  /// A volume or range that selects now.
  std::optional<Choosing> choosing;

  double point_size = 2;  ///< pixels
  bool show_graph = false, show_rest = false, show_ground = true;
  bool show_markers = true;
  bool show_history = false, show_residuals = false;
  bool cut_tets = false;                            ///< the structure of a solid is shown cut open
  gpu::Section section;                             ///< where
  std::string color_by;                             ///< an attribute's name; empty: plain
  std::optional<document::FieldKind> heat;          ///< what the edit does, in place of an attribute
  std::optional<gpu::Colormap> colormap;            ///< nothing: the usual one of what is shown
  std::optional<document::ValueRange> color_range;  ///< nothing: the usual one
  std::optional<Index> clicked;                     ///< the point that was clicked last
  bool show_onion = false;                          ///< ghosts of other frames
  int onion_frames = 2, onion_step = 2;             ///< so many before and after, so many frames apart

  /// A drag by gizmo or by G, R and S that runs now.
  std::optional<Manipulation> manipulation;
  /// Begun by keys: the mouse moves it without a button, a click confirms.
  bool modal = false;
};

class Session;

/// That a tool shows.
GizmoKind gizmo_kind(Tool tool);

/// The gizmo of the volume that is chosen by, else of the chosen handle, as tool and space say; nothing where there is
/// none.
std::optional<Gizmo> gizmo_of(Session& session, const View& view);

/// Begins a drag of what has the gizmo at the mouse; false where there is none. `modal`: by a key.
bool begin_manipulation(Session& session, View& view, GizmoKind kind, GizmoPart part, bool modal);
/// For each motion of the mouse: moves it.
void update_manipulation(Session& session, View& view, int modifiers);
/// After press(), confirm() or cancel() of View::manipulation: hands its motion to the session, and ends both where it
/// is over.
void follow_manipulation(Session& session, View& view);

/// A tenth of the ground's cell: the step of Ctrl.
double snap_length(const Session& session);

/// Starts View::glide from the present camera.
void glide_to(View& view, const gpu::Camera& camera);

}  // namespace sinew::editor
