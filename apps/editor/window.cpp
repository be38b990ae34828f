#include "apps/editor/window.h"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstring>

#include "engine/geometry/error.h"
#include "engine/io/io.h"

namespace sinew::editor {

namespace {

std::string last_glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "no reason given";
}

GLFWwindow* create(const WindowOptions& options) {
  if (glfwInit() != GLFW_TRUE)
    throw InputError("no window can be opened here: expected a display (DISPLAY or WAYLAND_DISPLAY), found none (" +
                     last_glfw_error() + "); the command line `sinew` works without one");
  if (glfwVulkanSupported() != GLFW_TRUE) {
    glfwTerminate();
    throw InputError("Vulkan: expected a loader and a driver, found none (Debian: mesa-vulkan-drivers)");
  }
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "sinew-editor");
  glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "sinew-editor");
  GLFWwindow* window = glfwCreateWindow(options.width, options.height, "Sinew", nullptr, nullptr);
  if (window == nullptr) {
    const std::string reason = last_glfw_error();
    glfwTerminate();
    throw InputError("no window can be opened here: " + reason);
  }
  glfwSetWindowSizeLimits(window, 480, 320, GLFW_DONT_CARE, GLFW_DONT_CARE);
  return window;
}

/// Pixels of the picture for one unit of the window system's coordinates.
double pixels_per_unit(GLFWwindow* window) {
  int pixels = 0, units = 0, height = 0;
  glfwGetFramebufferSize(window, &pixels, &height);
  glfwGetWindowSize(window, &units, &height);
  return units > 0 ? static_cast<double>(pixels) / units : 1;
}

}  // namespace

Window::Window(const WindowOptions& options) {
  if (!options.play.empty()) {
    const std::vector<std::byte> bytes = io::load_bytes(options.play);
    to_play_ = parse_events(options.play, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    playing_ = true;
  }
  if (!options.record.empty()) {
    record_.open(options.record);
    if (!record_) throw file_error(options.record, "a file that can be written", std::strerror(errno));
  }
  window_ = create(options);
  glfwSetWindowUserPointer(window_, this);
  const int shapes[] = {GLFW_ARROW_CURSOR, GLFW_IBEAM_CURSOR,   GLFW_CROSSHAIR_CURSOR,
                        GLFW_HAND_CURSOR,  GLFW_HRESIZE_CURSOR, GLFW_VRESIZE_CURSOR};
  for (std::size_t i = 0; i < std::size(shapes); ++i) cursors_[i] = glfwCreateStandardCursor(shapes[i]);
  listen();
  play_start_ = played_ = now();
}

Window::~Window() {
  for (void* cursor : cursors_)
    if (cursor != nullptr) glfwDestroyCursor(static_cast<GLFWcursor*>(cursor));
  glfwDestroyWindow(window_);
  glfwTerminate();
}

Window& Window::of(GLFWwindow* window) {
  return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

void Window::listen() {
  using What = InputEvent::What;
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
    const double factor = pixels_per_unit(w);
    of(w).add({.what = What::Move, .x = x * factor, .y = y * factor});
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int modifiers) {
    if (button <= GLFW_MOUSE_BUTTON_MIDDLE)
      of(w).add({.what = What::Button, .code = button, .action = action, .modifiers = modifiers});
  });
  glfwSetScrollCallback(window_,
                        [](GLFWwindow* w, double x, double y) { of(w).add({.what = What::Wheel, .x = x, .y = y}); });
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int modifiers) {
    if (key != GLFW_KEY_UNKNOWN) of(w).add({.what = What::Key, .code = key, .action = action, .modifiers = modifiers});
  });
  glfwSetCharCallback(
      window_, [](GLFWwindow* w, unsigned code) { of(w).add({.what = What::Text, .code = static_cast<int>(code)}); });
  glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
    of(w).add({.what = What::Drop, .paths = {paths, paths + count}});
  });
  glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int width, int height) {
    of(w).add({.what = What::Resize, .x = static_cast<double>(width), .y = static_cast<double>(height)});
  });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) {
    const VkExtent2D size = of(w).size();
    of(w).add({.what = What::Resize, .x = static_cast<double>(size.width), .y = static_cast<double>(size.height)});
  });
  glfwSetWindowFocusCallback(window_,
                             [](GLFWwindow* w, int focused) { of(w).add({.what = What::Focus, .action = focused}); });
  glfwSetWindowCloseCallback(window_, [](GLFWwindow* w) {
    glfwSetWindowShouldClose(w, GLFW_FALSE);
    of(w).add({.what = What::Close});
  });
}

void Window::add(InputEvent event) {
  using What = InputEvent::What;
  if (playing_ && event.what != What::Resize && event.what != What::Close) return;
  event.time = now();
  if (record_.is_open() && event.what != What::Resize) {
    if (record_start_ < 0) record_start_ = event.time;
    record_ << text_of(event, record_start_) << std::endl;
  }
  events_.push_back(std::move(event));
}

void Window::play() {
  if (hold_play_) play_start_ += now() - played_;
  played_ = now();
  if (hold_play_) return;
  while (!to_play_.empty() && play_start_ + to_play_.front().time <= now()) {
    InputEvent event = std::move(to_play_.front());
    to_play_.pop_front();
    if (event.what == InputEvent::What::Resize)
      glfwSetWindowSize(window_, static_cast<int>(event.x), static_cast<int>(event.y));
    event.time = now();
    events_.push_back(std::move(event));
  }
}

void Window::wait(double seconds) {
  if (playing_ && !to_play_.empty() && !hold_play_) {
    const double due = std::max(0.0, play_start_ + to_play_.front().time - now());
    seconds = seconds < 0 ? due : std::min(seconds, due);
  }
  if (seconds < 0) {
    glfwWaitEvents();
  } else if (seconds > 0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
  play();
}

void Window::wake() {
  glfwPostEmptyEvent();
}

gpu::DeviceOptions Window::device_options() const {
  gpu::DeviceOptions options;
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  if (names == nullptr) throw InputError("Vulkan: expected a driver that can show pictures in this window, found none");
  options.instance_extensions.assign(names, names + count);
  options.create_surface = [window = window_](VkInstance instance) {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    gpu::vk_check(glfwCreateWindowSurface(instance, window, nullptr, &surface), "glfwCreateWindowSurface");
    return surface;
  };
  return options;
}

VkExtent2D Window::size() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE) width = height = 0;
  return {static_cast<std::uint32_t>(std::max(0, width)), static_cast<std::uint32_t>(std::max(0, height))};
}

double Window::content_scale() const {
  float x = 1, y = 1;
  glfwGetWindowContentScale(window_, &x, &y);
  return std::clamp(static_cast<double>(x), 1.0, 4.0);
}

void Window::set_title(const std::string& title) {
  if (title == title_) return;
  title_ = title;
  glfwSetWindowTitle(window_, title.c_str());
}

void Window::set_cursor(CursorShape shape) {
  if (shape == cursor_) return;
  cursor_ = shape;
  glfwSetCursor(window_, static_cast<GLFWcursor*>(cursors_[static_cast<std::size_t>(shape)]));
}

std::string Window::clipboard() const {
  const char* text = glfwGetClipboardString(window_);
  return text != nullptr ? text : "";
}

void Window::set_clipboard(const std::string& text) {
  glfwSetClipboardString(window_, text.c_str());
}

}  // namespace sinew::editor
