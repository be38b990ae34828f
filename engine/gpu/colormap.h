#pragma once
/// Numbers as colours: maps that are read in order of lightness or hue.

#include <array>
#include <optional>
#include <string_view>

#include "engine/gpu/points.h"

namespace sinew::gpu {

/// Viridis: dark violet to yellow, lightness rises evenly [van der Walt and Smith 2015]. Turbo: blue over green to red,
/// finer steps, lightness rises and falls [Mikhailov 2019]. CoolWarm: blue over light grey in the middle to red, for
/// signed numbers [Moreland 2009].
enum class Colormap { Viridis, Turbo, CoolWarm };
inline constexpr std::array colormap_names{"viridis", "turbo", "cool-warm"};
std::optional<Colormap> colormap_named(std::string_view name);

/// 0..1, clamped; the marks are 0.
PointColor color_at(Colormap map, double x);

}  // namespace sinew::gpu
