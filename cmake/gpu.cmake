# Vulkan: see engine/gpu
