#pragma once
/// A simulated range scanner. From each of 22 places it shoots rays on a grid, by perspective, and measures where they
/// meet a surface. Like a real one it makes noise along the ray, sees little at grazing angles, nothing of dark spots
/// and nothing that its camera, half a metre beside the laser, cannot see; and where a ray meets an edge, it now and
/// then reports a point in the air behind it.

#include <cstdint>

#include "engine/geometry/shape.h"

namespace sinew::samples {

/// The sample animal, scanned: exactly `points` points, scan after scan, un-merged. Attributes: normal (of the scan's
/// own grid, towards the scanner), color, intensity in [0, 1], confidence in [0, 1] (cosine between normal and ray;
/// points in the air have little), scan (number of the place). The same for the same arguments on any number of
/// threads. points >= 1000.
Shape sample_animal(std::size_t points, std::uint64_t seed = 1);

}  // namespace sinew::samples
