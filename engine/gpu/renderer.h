#pragma once
/// Renderer: draws a Scene in two steps. prepare_scene() records passes that draw shapes into images of the renderer's
/// own; compose_scene() then draws the finished picture (eye-dome lighting, ground, lines, dots) inside a render pass
/// of the caller's, into which the caller may draw more (a user interface) afterwards.
///
///   begin_frame(device, frame);                                   // waits for the picture before
///   set_colors / pose_points / set_positions ...                  // what moved
///   prepare_scene(device, renderer, frame, scene, extent);
///   VkCommandBuffer commands = begin_pass(device, frame);
///   begin_target(commands, target);                               // Swapchain or Offscreen
///   compose_scene(renderer, commands, scene);
///   ... more drawing into the same render pass ...
///   vkCmdEndRenderPass(commands);
///   end_pass(device, frame);
///   submit(...)

#include <memory>

#include "engine/gpu/frame.h"
#include "engine/gpu/paths.h"
#include "engine/gpu/scene.h"

namespace sinew::gpu {

/// A render pass with one colour attachment of this format, which ends in `layout`. Its contents before are not kept:
/// compose_scene() covers all of it. All passes of one format are compatible with each other.
Owned<VkRenderPass> create_final_pass(const Device& device, VkFormat format, VkImageLayout layout);

struct Renderer;
struct DestroyRenderer {
  void operator()(Renderer* renderer) const;
};
using RendererHandle = std::unique_ptr<Renderer, DestroyRenderer>;

/// `format` is that of the final pass. It must go before the device, and after its pictures have finished.
RendererHandle create_renderer(const Device& device, const Paths& paths, VkFormat format);

void prepare_scene(const Device& device, Renderer& renderer, Frame& frame, const Scene& scene, VkExtent2D extent);
void compose_scene(Renderer& renderer, VkCommandBuffer commands, const Scene& scene);

}  // namespace sinew::gpu
