#pragma once
/// Scene: what one picture shows, as plain data that is filled anew for each picture. Coordinates are double, relative
/// to one origin that the caller chose (a shape's own, usually); lengths on the screen are pixels.

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/gpu/camera.h"
#include "engine/gpu/points.h"

namespace sinew::gpu {

struct Color {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;

  /// 0xf2932e, opacity 0..1.
  static constexpr Color hex(std::uint32_t rgb, double opacity = 1) {
    return {static_cast<std::uint8_t>(rgb >> 16), static_cast<std::uint8_t>(rgb >> 8 & 255),
            static_cast<std::uint8_t>(rgb & 255), static_cast<std::uint8_t>(std::min(255.0, 256 * opacity))};
  }
};

/// Round splats.
struct CloudItem {
  const Points* points = nullptr;
  double size = 2;  ///< diameter, pixels
  /// Draw only so many: the first of the points' order, or of the points where they have none.
  std::size_t count = ~std::size_t{0};
  bool rest = false;              ///< the rest shape in place of the bent one
  double ghost = 0;               ///< 0: solid; otherwise opacity of a see-through ghost
  Color ghost_color{0, 0, 0, 0};  ///< of the ghost; with opacity 0 the look's
};

/// Triangles, seen from both sides.
struct MeshItem {
  const Points* points = nullptr;
  const Triangles* triangles = nullptr;
  bool flat = false;  ///< one normal a face; otherwise the points' normals
  bool rest = false;
  double ghost = 0;
  Color ghost_color{0, 0, 0, 0};
};

struct Splats;

/// Gaussian splats (splats.h), over the ground and what is solid behind them.
struct SplatItem {
  const Splats* splats = nullptr;
};

struct Line {
  Eigen::Vector3d from, to;
  Color color;
  double width = 1;   ///< pixels
  double hidden = 0;  ///< part that is seen through what stands before it: 0 none, 1 all
};

struct Dot {
  Eigen::Vector3d position;
  Color color;
  double radius = 2.5;  ///< pixels, of the disc alone
  double outline = 0;   ///< pixels around it
  Color outline_color{16, 18, 22, 255};
  double hidden = 0;
};
/// A control point as it always looks: a ball of 7 pixels with a dark outline, faintly seen through the shape.
Dot handle_dot(const Eigen::Vector3d& position, Color color);

struct Scene;
/// Markers of a motion as they always look: small balls in the look's colour of handles, hollow where the marker was
/// not seen, and bones as thin lines. `scale`: of lengths on the screen.
void add_markers(std::span<const Eigen::Vector3d> seen, std::span<const Eigen::Vector3d> unseen,
                 std::span<const std::pair<Eigen::Vector3d, Eigen::Vector3d>> bones, double scale, Scene& scene);

struct Ground {
  bool show = true;
  Eigen::Vector3d middle{0, 0, 0};  ///< the plane goes through it; the grid fades with the distance from it
  double cell = 0.1;                ///< length of a cell; every tenth line is stronger
  double cells = 30;                ///< cells from the middle to where it has faded away
};
/// Under `bounds`: cells of a round length (1, 2 or 5 times a power of ten) at most a third of the diagonal.
Ground ground_below(const Bounds& bounds, UpAxis up);

/// Colours and light; dark_look() is the standard.
struct Look {
  Color backdrop_top = Color::hex(0x262a2f), backdrop_bottom = Color::hex(0x191b1e);
  Color grid = Color::hex(0xffffff, 0.13);
  Color handle = Color::hex(0xf2932e), fixed = Color::hex(0x5b9bea), rigid = Color::hex(0xa47de0);
  Color outline = Color::hex(0xffd08a);  ///< around what is selected
  Color ghost = Color::hex(0xaebccf);
  double edl_strength = 14;  ///< eye-dome lighting; 0: none
  double edl_radius = 1.5;   ///< pixels
};
Look dark_look();
Look light_look();

struct Scene {
  Camera camera;
  UpAxis up = UpAxis::Y;
  Look look;
  Ground ground;
  std::vector<CloudItem> clouds;
  std::vector<MeshItem> meshes;
  std::vector<SplatItem> splats;
  std::vector<Line> lines;
  std::vector<Dot> dots;
  bool outline_selected =
      false;                 ///< a line around points marked mark_selected; costs a little, so only where there are any
  bool smooth_edges = true;  ///< four samples a pixel where the device has them; false: faster
};

}  // namespace sinew::gpu
