#include "engine/gpu/swapchain.h"

#include <sys/wait.h>
#include <unistd.h>
#include <csignal>
#include <cstdlib>
#include <random>

#include "tests/gpu/gpu_test.h"

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

namespace sinew::gpu {
namespace {

/// The display of the environment, or an invisible one of this test's own.
class Display {
 public:
  Display() {
    if (std::getenv("DISPLAY") != nullptr) return;
    int numbers[2];
    if (pipe(numbers) != 0) return;
    server_ = fork();
    if (server_ == 0) {
      const std::string out = std::to_string(numbers[1]);
      execlp("Xvfb", "Xvfb", "-displayfd", out.c_str(), "-screen", "0", "1400x900x24", "-noreset", "-nolisten", "tcp",
             nullptr);
      _exit(127);
    }
    close(numbers[1]);
    char text[16]{};
    const ssize_t count = read(numbers[0], text, sizeof text - 1);
    close(numbers[0]);
    if (count > 0) setenv("DISPLAY", (":" + std::to_string(std::atoi(text))).c_str(), 1);
  }
  ~Display() {
    if (server_ <= 0) return;
    kill(server_, SIGTERM);
    waitpid(server_, nullptr, 0);
    unsetenv("DISPLAY");
  }

 private:
  pid_t server_ = 0;
};

class SwapchainTest : public GpuTest {
 protected:
  void SetUp() override {
    ASSERT_EQ(glfwInit(), GLFW_TRUE) << "no display, and none could be started (Debian: xvfb)";
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(640, 480, "test", nullptr, nullptr);
    ASSERT_NE(window_, nullptr);
    DeviceOptions options;
    options.validation = true;
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    options.instance_extensions.assign(names, names + count);
    options.create_surface = [this](VkInstance instance) {
      VkSurfaceKHR surface = VK_NULL_HANDLE;
      vk_check(glfwCreateWindowSurface(instance, window_, nullptr, &surface), "glfwCreateWindowSurface");
      return surface;
    };
    device_ = create_device(options);
  }
  void TearDown() override {
    if (device_ == nullptr) return;
    const std::shared_ptr<Messages> messages = device_->messages;
    device_.reset();
    for (const std::string& message : messages->take()) ADD_FAILURE() << message;
    glfwDestroyWindow(window_);
    glfwTerminate();
    GpuTest::TearDown();
  }

  /// One picture as a window draws it; false where there was none to draw into.
  bool draw(Renderer& renderer, Frame& frame, Swapchain& swapchain, const Scene& scene) {
    begin_frame(*device_, frame);
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    if (!acquire(*device_, swapchain, {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)}))
      return false;
    end_picture(*device_, frame, begin_picture(*device_, renderer, frame, scene, final_target(swapchain)));
    submit(*device_, frame, acquired(swapchain), drawn(swapchain));
    present(*device_, swapchain);
    return true;
  }

  void resize_storm(const Paths& paths, int times) {
    std::vector<Eigen::Vector3d> points, normals;
    sphere(2000, points, normals);
    const Points ball = create_points(*device_, false, points, normals);
    Scene scene = plain_scene();
    scene.smooth_edges = false;
    scene.clouds.push_back({&ball, 2});
    Swapchain swapchain = create_swapchain(*device_);
    const RendererHandle renderer = create_renderer(*device_, paths, swapchain.format);
    Frame frame = create_frame(*device_);
    std::mt19937 random(1);
    int pictures = 0;
    for (int i = 0; i < times; ++i) {
      glfwSetWindowSize(window_, static_cast<int>(40 + random() % 300), static_cast<int>(40 + random() % 300));
      glfwPollEvents();
      pictures += draw(*renderer, frame, swapchain, scene);
    }
    EXPECT_GT(pictures, times / 2);
    EXPECT_GE(swapchain.image_count(), 2u);
    wait_idle(*device_);
  }

  Display display_;
  GLFWwindow* window_ = nullptr;
  std::unique_ptr<Device> device_;
};

TEST_F(SwapchainTest, AStormOfFiveHundredSizesLeavesNothingBehind) {
  resize_storm({}, 500);
}

TEST_F(SwapchainTest, SoDoesOneDrawnByTheShaders) {
  Paths paths;
  paths.draw_on_device = true;
  resize_storm(paths, 60);
}

TEST_F(SwapchainTest, AWindowWithoutAreaIsWaitedFor) {
  Swapchain swapchain = create_swapchain(*device_);
  EXPECT_FALSE(acquire(*device_, swapchain, {0, 100}));
  EXPECT_FALSE(acquire(*device_, swapchain, {100, 0}));
}

}  // namespace
}  // namespace sinew::gpu
