#pragma once
/// Paths: where work is done, measured on the device at start. A GPU skins and draws points itself; a software driver
/// does both far slower than plain code on the same processor.

#include <string>

#include "engine/gpu/device.h"

namespace sinew::gpu {

struct Paths {
  bool skin_on_device = false;                 ///< skin.comp; otherwise skin_on_cpu() into mapped memory
  bool splat_on_device = false;                ///< points drawn by point.vert; otherwise by splat.h
  double device_skin_ms = 0, cpu_skin_ms = 0;  ///< for measured_points of 4 influences each, maps included
  std::string sentence;                        ///< "llvmpipe, CPU skinning": for a status line
};
inline constexpr std::size_t measured_points = 20'000;

/// Takes some tens of milliseconds. Splatting follows the device's kind: only where device and processor share their
/// memory is the CPU's picture at once the device's.
Paths measure_paths(const Device& device);

}  // namespace sinew::gpu
