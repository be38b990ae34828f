#pragma once
/// A shape, and what an edit does to it, as a scene for the renderer. Coordinates are relative to the shape's origin.

#include <set>
#include <string>
#include <vector>

#include "engine/document/evaluate.h"
#include "engine/gpu/device.h"
#include "engine/gpu/points.h"
#include "engine/gpu/scene.h"

namespace sinew::app {

/// What --show can name.
inline constexpr const char* show_names[] = {"graph", "handles", "fixed", "rest", "ground"};

struct View {
  std::string name = "iso";  ///< of look_from(), or "ex,ey,ez,tx,ty,tz"
  bool z_up = false;
  int width = 1280, height = 720;
  double point_size = 0;  ///< pixels; 0: from the number of points
};

/// Keeps the buffers that `scene` points to.
struct DrawnShape {
  gpu::Points points, rest_points;
  gpu::Triangles triangles;
  gpu::Scene scene;
};

/// `evaluation` may be null: then the shape as it is. Throws InputError where the view is none.
void fill_scene(const gpu::Device& device, const Shape& input, const document::Evaluation* evaluation, const View& view,
                const std::set<std::string>& show, DrawnShape& out);

}  // namespace sinew::app
