#include "engine/gpu/colormap.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace sinew::gpu {

namespace {

using Rgb = Eigen::Vector3d;  ///< 0..1, as a display takes it

PointColor packed(const Rgb& color) {
  const auto byte = [&](int c) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(color[c], 0.0, 1.0))); };
  return {byte(0), byte(1), byte(2), 0};
}

/// From nine of its colours, straight lines between them.
PointColor viridis(double x) {
  constexpr std::array<std::array<double, 3>, 9> table{{{68, 1, 84},
                                                        {71, 44, 122},
                                                        {59, 81, 139},
                                                        {44, 113, 142},
                                                        {33, 144, 141},
                                                        {39, 173, 129},
                                                        {92, 200, 99},
                                                        {170, 220, 50},
                                                        {253, 231, 37}}};
  const double at = x * 8;
  const std::size_t low = std::min<std::size_t>(7, static_cast<std::size_t>(at));
  const double part = at - static_cast<double>(low);
  const auto channel = [&](std::size_t c) {
    return static_cast<std::uint8_t>(std::lround(table[low][c] + part * (table[low + 1][c] - table[low][c])));
  };
  return {channel(0), channel(1), channel(2), 0};
}

/// The polynomials of degree 5 that its author gives for it.
PointColor turbo(double x) {
  constexpr double r[] = {0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943};
  constexpr double g[] = {0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604};
  constexpr double b[] = {0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973};
  const auto value = [&](const double(&c)[6]) {
    return c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
  };
  return packed({value(r), value(g), value(b)});
}

/// Polar CIELAB: magnitude, saturation, hue [Moreland 2009, section 4.2].
struct Msh {
  double M, s, h;
};

/// D65 white, sRGB [IEC 61966-2-1].
Rgb display_color(const Msh& color) {
  const double L = color.M * std::cos(color.s), a = color.M * std::sin(color.s) * std::cos(color.h),
               b = color.M * std::sin(color.s) * std::sin(color.h);
  const auto f = [](double t) { return t > 6.0 / 29 ? t * t * t : 3 * 36.0 / 841 * (t - 4.0 / 29); };
  const double l = (L + 16) / 116;
  const Eigen::Vector3d xyz(0.95047 * f(l + a / 500), f(l), 1.08883 * f(l - b / 200));
  Eigen::Matrix3d to_rgb;
  to_rgb << 3.2404542, -1.5371385, -0.4985314, -0.9692660, 1.8760108, 0.0415560, 0.0556434, -0.2040259, 1.0572252;
  const auto gamma = [](double c) { return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055; };
  return (to_rgb * xyz).unaryExpr(gamma);
}

/// Between a saturated end and the unsaturated middle; its hue there turns so that the path keeps the magnitude's
/// distance even [section 4.3, AdjustHue].
PointColor cool_warm(double x) {
  constexpr Msh cool{80, 1.08, -1.1}, warm{80, 1.08, 0.5};
  constexpr double middle = 88;
  const Msh& end = x < 0.5 ? cool : warm;
  const double spin = end.s * std::sqrt(middle * middle - end.M * end.M) / (end.M * std::sin(end.s));
  const double hue = end.h > -std::numbers::pi / 3 ? end.h + spin : end.h - spin;
  const double t = std::abs(2 * x - 1);  // 0 in the middle, 1 at the end
  return packed(display_color({middle + t * (end.M - middle), t * end.s, hue + t * (end.h - hue)}));
}

}  // namespace

std::optional<Colormap> colormap_named(std::string_view name) {
  for (std::size_t i = 0; i < colormap_names.size(); ++i)
    if (name == colormap_names[i]) return static_cast<Colormap>(i);
  return std::nullopt;
}

PointColor color_at(Colormap map, double x) {
  const double at = std::clamp(x, 0.0, 1.0);
  switch (map) {
    case Colormap::Turbo: return turbo(at);
    case Colormap::CoolWarm: return cool_warm(at);
    default: return viridis(at);
  }
}

}  // namespace sinew::gpu
