#pragma once
/// Gui: Dear ImGui on the window's events and on the renderer's final pass, with its fonts. The events are fed by hand,
/// so that recorded ones go the same way as real ones.

#include <imgui.h>

#include "apps/editor/fonts.h"
#include "apps/editor/theme.h"
#include "apps/editor/window.h"
#include "engine/gpu/frame.h"

namespace sinew::editor {

/// Of the Gui that is alive.
const Fonts& fonts();

class Gui {
 public:
  /// `pass` is compatible with the one that draw() is called in. Throws InputError where a font is missing.
  Gui(Window& window, const gpu::Device& device, VkRenderPass pass, std::uint32_t image_count);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  /// Between pictures: colours and measures, and the fonts anew where the scale is another.
  void use(const Theme& theme, float scale);

  /// Pictures for fonts().pictures, from the next use() on.
  void show_pictures(std::vector<gpu::Picture> pictures);

  void feed(const InputEvent& event);
  void begin(VkExtent2D size);  ///< a frame of the interface; end it by ImGui::Render or ImGui::EndFrame
  void draw(VkCommandBuffer commands);

  static CursorShape cursor();  ///< that the interface wants

 private:
  void start_backend();

  Window& window_;
  const gpu::Device& device_;
  VkRenderPass pass_;
  std::uint32_t image_count_;
  gpu::Owned<VkDescriptorPool> pool_;
  bool backend_ = false;
  float font_scale_ = 0;
  std::vector<gpu::Picture> pictures_;
  double last_frame_ = 0;
  std::string clipboard_;  ///< the text that ImGui was given, alive until it asks again
};

}  // namespace sinew::editor
