#pragma once
/// A shape, and what an edit does to it, as a scene for the renderer. Coordinates are relative to the shape's origin.

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/sinew/field.h"
#include "engine/document/evaluate.h"
#include "engine/gpu/device.h"
#include "engine/gpu/points.h"
#include "engine/gpu/scene.h"
#include "engine/gpu/solid.h"
#include "engine/gpu/splats.h"

namespace sinew::app {

/// What --show can name.
inline constexpr const char* show_names[] = {"graph",     "tets", "handles", "markers", "fixed",  "rigid",
                                             "stiffness", "rest", "ground",  "points",  "energy", "displacement"};

struct View {
  std::string name = "iso";  ///< of look_from(), or "ex,ey,ez,tx,ty,tz"
  bool z_up = false;
  int width = 1280, height = 720;
  double point_size = 0;                ///< pixels; 0: from the number of points
  std::optional<gpu::Section> section;  ///< of the tets
  int frame = 1;                        ///< whose markers are drawn
  int turntable = 0;                    ///< so many pictures once around the shape; 0: one from where the view is
  FieldOptions color;                   ///< whose numbers are shown as colours
};

/// Keeps the buffers that `scene` points to.
struct DrawnShape {
  gpu::Points points, rest_points;
  gpu::Triangles triangles;
  gpu::Splats splats;
  std::vector<gpu::SolidItem> solids;
  std::optional<Field> field;        ///< that the colours show
  std::vector<gpu::Camera> cameras;  ///< of View::turntable, in order; or the scene's alone
  gpu::Scene scene;
};

/// `evaluation` may be null: then the shape as it is, and `show` has no tets. Tets are drawn in place of
/// the shape. A shape without faces that holds splats is drawn as such, unless `show` has "points", and framed without
/// the few that are far from the others. Throws InputError where the view is none.
void fill_scene(const gpu::Device& device, const Shape& input, const document::Evaluation* evaluation, const View& view,
                const std::set<std::string>& show, DrawnShape& out);

}  // namespace sinew::app
