#include "tests/gpu/gpu_test.h"

#include <cmath>
#include <cstdlib>
#include <numbers>

namespace sinew::gpu {
namespace {

std::unique_ptr<Device>& device() {
  static std::unique_ptr<Device> instance;
  return instance;
}

std::string joined(const std::vector<std::string>& texts) {
  std::string out;
  for (const std::string& text : texts) out += text + "\n";
  return out;
}

class GpuEnvironment : public ::testing::Environment {
 public:
  void SetUp() override {
    setenv("VK_LAYER_ENABLES", "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT", 1);
    DeviceOptions options;
    options.validation = true;
    device() = create_device(options);
    messages_ = device()->messages;
    ASSERT_EQ(joined(messages_->take()), "");
    for (const bool two_submits : {false, true}) {
      const std::string said = joined(messages_of_planted_hazard(*device(), two_submits));
      ASSERT_NE(said.find("WRITE_AFTER_WRITE"), std::string::npos) << "a planted hazard was not caught: " << said;
    }
  }
  void TearDown() override {
    device().reset();
    EXPECT_EQ(joined(messages_->take()), "") << "at the end of the device";
  }

 private:
  std::shared_ptr<Messages> messages_;
};

const auto* const environment = ::testing::AddGlobalTestEnvironment(new GpuEnvironment);

}  // namespace

const Device& test_device() {
  return *device();
}

std::vector<std::string> messages_of_planted_hazard(const Device& device, bool two_submits) {
  const Buffer from = create_buffer(device, 1024, Memory::Upload), to = create_buffer(device, 1024, Memory::Device);
  const auto copy = [&](VkCommandBuffer commands) {
    const VkBufferCopy region{0, 0, 1024};
    vkCmdCopyBuffer(commands, from.handle, to.handle, 1, &region);
  };
  Frame first = create_frame(device), second = create_frame(device);
  copy(begin_pass(device, first));
  end_pass(device, first);
  if (two_submits) submit(device, first, VK_NULL_HANDLE, VK_NULL_HANDLE);
  Frame& other = two_submits ? second : first;
  copy(begin_pass(device, other));
  end_pass(device, other);
  submit(device, other, VK_NULL_HANDLE, VK_NULL_HANDLE);
  wait_idle(device);
  finish(device, first);
  finish(device, second);
  return device.messages->take();
}

void GpuTest::TearDown() {
  EXPECT_EQ(joined(test_device().messages->take()), "");
}

void sphere(std::size_t count, std::vector<Eigen::Vector3d>& points, std::vector<Eigen::Vector3d>& normals) {
  points.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double angle = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0));
    const double radius = std::sqrt(1 - z * z);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  normals = points;
}

Scene plain_scene() {
  Scene scene;
  scene.ground.show = false;
  Bounds bounds;
  bounds.add({-1, -1, -1});
  bounds.add({1, 1, 1});
  look_from(scene.camera, "front", UpAxis::Y);
  frame_bounds(scene.camera, bounds, 1);
  return scene;
}

}  // namespace sinew::gpu
