#pragma once
/// Paths: where work is done, measured on the device at start. A GPU skins and draws points itself; a software driver
/// does both far slower than plain code on the same processor.

#include <string>

#include "engine/gpu/device.h"

namespace sinew::gpu {

struct Paths {
  bool skin_on_device = false;                 ///< skin.comp; otherwise skin_on_cpu() into mapped memory
  bool draw_on_device = false;                 ///< shapes drawn by the shaders; otherwise by raster.h
  double device_skin_ms = 0, cpu_skin_ms = 0;  ///< for measured_points of 4 influences each, maps included
  std::string sentence;                        ///< "llvmpipe, CPU skinning": for a status line
};
inline constexpr std::size_t measured_points = 20'000;

/// Takes some tens of milliseconds. Drawing follows the device's kind: where the device is the processor, plain code is
/// faster than its shaders; anywhere else the picture would have to be sent.
Paths measure_paths(const Device& device);

}  // namespace sinew::gpu
