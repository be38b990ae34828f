#pragma once
/// Editor: the program with a window. Its one loop waits until something happens, hands events to interface and mouse,
/// takes what the session's threads have found, and draws where there is something new.

#include <deque>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/editor/gui.h"
#include "apps/editor/lod.h"
#include "apps/editor/portal.h"
#include "apps/editor/portraits.h"
#include "apps/editor/ui.h"
#include "engine/gpu/swapchain.h"

namespace sinew::editor {

struct EditorOptions {
  std::vector<std::string> files;
  WindowOptions window;
  bool validation = false;
  std::string sample;  ///< path of the sample scan; empty: none
  std::string
      times;  ///< a line a picture of a drag goes there: seconds from the mouse event to its shape on the screen
};

class Editor {
 public:
  /// Throws InputError where there is no display, no Vulkan, no fonts.
  explicit Editor(const EditorOptions& options);
  ~Editor();

  /// Until the window is closed.
  void run();

  /// What the validation layer said; to be read after the editor is gone.
  std::shared_ptr<gpu::Messages> messages() const { return device_->messages; }

 private:
  void answer(Request request);
  void open(const std::vector<std::string>& paths);
  void open_later(std::vector<std::string> paths);
  void unless_unsaved(const std::string& path, std::function<void()> open);
  void open_next();
  void choose_file_to_open();
  void choose_poses();
  void choose_control_points();
  void choose_file_to_save();
  void choose_file_to_export();
  void choose_name_of_turntable();
  void ask_for_file(FileRequest request);
  void take_portal_answer(const FileRequest& request, const PortalAnswer& answer,
                          const std::vector<std::string>& changes);
  void save_turntable(const std::string& path);
  void copy_command();
  void take_pictures();
  void show_recent_pictures();
  void picture_recent();
  void save_screenshot(const std::string& path);
  void draw_screenshot(const std::string& path);
  void quit();

  void take_events();
  void deliver(const InputEvent& event);
  void press_key(const InputEvent& event);
  void take_changes();
  void show_new_input();
  void wait_for_shape();
  void interface_frame(VkExtent2D size);
  void use_preferences();
  bool wants_frame() const;
  double patience() const;
  void draw();
  void draw_scene(bool moving);

  Window window_;
  std::unique_ptr<gpu::Device> device_;
  gpu::Paths paths_;
  gpu::Swapchain swapchain_;
  gpu::RendererHandle renderer_;
  gpu::Frame frame_;
  std::unique_ptr<Gui> gui_;

  std::string preferences_path_;
  Preferences preferences_, saved_preferences_;
  View view_;
  Session session_;
  Context context_;
  Stage stage_;
  Mouse mouse_;
  Ui ui_;
  DetailController detail_;
  bool validation_ = false;
  bool copy_when_saved_ = false;      ///< the command line, once its edit is on the disk
  bool no_portal_ = false;            ///< it was asked, and there is none
  bool wants_picture_ = false;        ///< of the input, as a recent file
  std::string turntable_, pictured_;  ///< what is being drawn, and for which file

  std::deque<std::vector<std::string>> to_open_;  ///< what was opened together
  bool quit_ = false;
  int frames_wanted_ = 2;
  bool shape_moved_ = false;
  bool acquired_late_ = false;
  gpu::Camera drawn_camera_;
  double last_step_ = 0;
  double picture_seconds_ = 0;  ///< of the last picture, drawn and shown

  std::ofstream times_;
  Background drawing_, picturing_, portal_;  ///< turntables, small pictures of recent files, the desktop's file dialog
  std::deque<std::pair<std::uint64_t, double>> asked_;  ///< tickets of a drag, and the times of their mouse events
};

}  // namespace sinew::editor
