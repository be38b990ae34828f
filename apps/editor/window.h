#pragma once
/// Window: the GLFW window, its events as InputEvent, and the recorder and player of those events. GLFW is seen by
/// window.cpp alone (its key codes also by gui.cpp).

#include <deque>
#include <fstream>
#include <string>
#include <vector>

#include "apps/editor/input.h"
#include "engine/gpu/device.h"

struct GLFWwindow;

namespace sinew::editor {

enum class CursorShape { Arrow, Text, Cross, Hand, Horizontal, Vertical };

struct WindowOptions {
  int width = 1280, height = 720;  ///< pixels of the picture, where the window system allows it
  std::string record;              ///< every event is written here; empty: none
  std::string play;                ///< events come from this file and no others; empty: from mouse and keyboard
};

class Window {
 public:
  /// Throws InputError where there is no display, or the file to play is none.
  explicit Window(const WindowOptions& options);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// For create_device: a surface of this window.
  gpu::DeviceOptions device_options() const;

  /// Waits until something happened or `seconds` have passed (0: does not wait; below 0: without limit).
  void wait(double seconds);
  /// From any thread: wait() returns.
  static void wake();

  /// Events since the last call, oldest first. The caller takes from the front what it has dealt with.
  std::deque<InputEvent>& events() { return events_; }
  /// While true, recorded events wait and their clock stands: who recorded them had waited, too.
  void hold_play(bool hold) { hold_play_ = hold; }
  bool played_all() const { return playing_ && to_play_.empty() && events_.empty(); }

  VkExtent2D size() const;       ///< of the picture in pixels; 0 x 0 while minimised
  double content_scale() const;  ///< of the display: 1, 1.5, 2 ...
  void set_title(const std::string& title);
  void set_cursor(CursorShape shape);
  std::string clipboard() const;
  void set_clipboard(const std::string& text);

 private:
  void add(InputEvent event);
  void play();
  static Window& of(GLFWwindow* window);
  void listen();

  GLFWwindow* window_ = nullptr;
  void* cursors_[6]{};
  CursorShape cursor_ = CursorShape::Arrow;
  std::deque<InputEvent> events_, to_play_;
  bool playing_ = false, hold_play_ = false;
  double play_start_ = 0, played_ = 0, record_start_ = -1;
  std::ofstream record_;
  std::string title_;
};

}  // namespace sinew::editor
