#pragma once
/// The compiled files of shaders/ by their names ("skin.comp"); the table is made by the build (cmake/gpu.cmake).

#include <cstdint>
#include <span>
#include <string_view>

namespace sinew::gpu {

std::span<const std::uint32_t> shader_code(std::string_view file);

}  // namespace sinew::gpu
