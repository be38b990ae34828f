#include "engine/gpu/device.h"

#include <cstdlib>

#include "engine/geometry/error.h"
#include "tests/gpu/gpu_test.h"

namespace sinew::gpu {
namespace {

using DeviceTest = GpuTest;

TEST_F(DeviceTest, AnUnknownNameIsRefusedWithTheNamesThatAreThere) {
  setenv("SINEW_VULKAN_DEVICE", "no such device", 1);
  try {
    create_device({});
    ADD_FAILURE() << "made";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("SINEW_VULKAN_DEVICE"), std::string::npos) << message;
    EXPECT_NE(message.find(test_device().name), std::string::npos) << message;
  }
  setenv("SINEW_VULKAN_DEVICE", test_device().name.substr(0, 4).c_str(), 1);
  EXPECT_EQ(create_device({})->name, test_device().name);
  unsetenv("SINEW_VULKAN_DEVICE");
}

TEST_F(DeviceTest, AnObjectThatOutlivesItsDeviceIsTold) {
  DeviceOptions options;
  options.validation = true;
  auto device = create_device(options);
  const std::shared_ptr<Messages> messages = device->messages;
  const VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, 0};
  VkFence leaked = VK_NULL_HANDLE;
  ASSERT_EQ(vkCreateFence(device->handle, &info, nullptr, &leaked), VK_SUCCESS);
  device.reset();
  EXPECT_FALSE(messages->take().empty());
}

TEST_F(DeviceTest, PathsAreMeasuredAndSaid) {
  const Paths paths = measure_paths(test_device());
  EXPECT_GT(paths.device_skin_ms, 0);
  EXPECT_GT(paths.cpu_skin_ms, 0);
  EXPECT_EQ(paths.skin_on_device, paths.device_skin_ms < paths.cpu_skin_ms);
  EXPECT_NE(paths.sentence.find(paths.skin_on_device ? "GPU skinning" : "CPU skinning"), std::string::npos);
}

TEST_F(DeviceTest, ImpossibleSizesAreRefused) {
  EXPECT_THROW(create_offscreen(test_device(), {0, 10}), InputError);
  EXPECT_THROW(create_offscreen(test_device(), {10, 1u << 20}), InputError);
}

}  // namespace
}  // namespace sinew::gpu
