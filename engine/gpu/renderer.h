#pragma once
/// Renderer: draws a Scene into a target, as the first thing in a render pass into which the caller may then draw more
/// (a user interface). One picture, of a window or without one:
///
///   begin_frame(device, frame);                                            // waits for the picture before
///   pose_points(...), set_colors(...), fill the Scene                      // what moved
///   VkCommandBuffer commands = begin_picture(device, renderer, frame, scene, target);
///   ... more drawing, in target's render pass ...
///   end_picture(device, frame, commands);
///   submit(device, frame, wait, signal);

#include <memory>

#include "engine/gpu/frame.h"
#include "engine/gpu/paths.h"
#include "engine/gpu/scene.h"

namespace sinew::gpu {

/// What a picture is drawn into: an image of a window or one in memory. The passes have one colour attachment and are
/// compatible with each other; `cover` begins with undefined contents, `keep` with an image that was copied into.
struct FinalTarget {
  VkExtent2D extent{0, 0};
  VkFormat format = VK_FORMAT_UNDEFINED;  ///< R8G8B8A8_UNORM or B8G8R8A8_UNORM
  VkImage image = VK_NULL_HANDLE;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  VkRenderPass cover = VK_NULL_HANDLE, keep = VK_NULL_HANDLE;
};
enum class Start { Cover, Keep };

/// The image ends in `layout`.
Owned<VkRenderPass> create_final_pass(const Device& device, VkFormat format, Start start, VkImageLayout layout);

struct Renderer;
struct DestroyRenderer {
  void operator()(Renderer* renderer) const;
};
using RendererHandle = std::unique_ptr<Renderer, DestroyRenderer>;

/// `format` is that of its targets. It must go before the device, and after its pictures have finished.
RendererHandle create_renderer(const Device& device, const Paths& paths, VkFormat format);

/// Records the passes of `scene` and returns within the target's render pass, with the picture complete but for what
/// the caller adds. The target's image is not in use elsewhere (submit's `wait` is for that).
VkCommandBuffer begin_picture(const Device& device, Renderer& renderer, Frame& frame, const Scene& scene,
                              const FinalTarget& target);
void end_picture(const Device& device, Frame& frame, VkCommandBuffer commands);

}  // namespace sinew::gpu
