#include "engine/gpu/scene.h"

#include <cmath>

namespace sinew::gpu {

Dot handle_dot(const Eigen::Vector3d& position, Color color) {
  Dot dot;
  dot.position = position;
  dot.color = color;
  dot.radius = 5.5;
  dot.outline = 1.5;
  dot.hidden = 0.35;
  return dot;
}

void add_markers(std::span<const Eigen::Vector3d> seen, std::span<const Eigen::Vector3d> unseen,
                 std::span<const std::pair<Eigen::Vector3d, Eigen::Vector3d>> bones, double scale, Scene& scene) {
  const Color color = scene.look.handle;
  Line bone;
  bone.color = {color.r, color.g, color.b, 200};
  bone.width = 1.5 * scale;
  bone.hidden = 0.5;
  for (const auto& [from, to] : bones) {
    bone.from = from;
    bone.to = to;
    scene.lines.push_back(bone);
  }
  for (const bool hollow : {true, false}) {
    for (const Eigen::Vector3d& at : hollow ? unseen : seen) {
      Dot dot = handle_dot(at, color);
      dot.radius = (hollow ? 2.5 : 3) * scale;
      dot.outline = (hollow ? 1.5 : 1) * scale;
      dot.hidden = 0.5;
      if (hollow) {
        dot.outline_color = color;
        dot.color.a = 40;
      }
      scene.dots.push_back(dot);
    }
  }
}

Ground ground_below(const Bounds& bounds, UpAxis up) {
  Ground ground;
  const int axis = up == UpAxis::Y ? 1 : 2;
  const double diagonal = bounds.diagonal() > 0 ? bounds.diagonal() : 1;
  const double wanted = diagonal / 3;
  const double decade = std::pow(10, std::floor(std::log10(wanted)));
  ground.cell = decade * (wanted < 2 * decade ? 1 : wanted < 5 * decade ? 2 : 5);
  ground.cells = 5 * diagonal / ground.cell;
  ground.middle = bounds.centre();
  ground.middle[axis] = bounds.empty() ? 0 : bounds.min[axis];
  return ground;
}

Look dark_look() {
  return {};
}

Look light_look() {
  Look look;
  look.backdrop_top = Color::hex(0xf3f4f6);
  look.backdrop_bottom = Color::hex(0xd9dce1);
  look.grid = Color::hex(0x1a2230, 0.16);
  look.outline = Color::hex(0xb35c00);
  look.ghost = Color::hex(0x5a6a80);
  return look;
}

}  // namespace sinew::gpu
