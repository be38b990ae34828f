#include "engine/gpu/device.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "engine/geometry/error.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu/sanitized.h"
#include "shaders/shared.h"

namespace sinew::gpu {
namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* messages) {
  static_cast<Messages*>(messages)->add(data->pMessage);
  return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(Messages& messages) {
  VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  info.pfnUserCallback = on_message;
  info.pUserData = &messages;
  return info;
}

void require_validation_layer() {
  std::uint32_t count = 0;
  vk_check(vkEnumerateInstanceLayerProperties(&count, nullptr), "vkEnumerateInstanceLayerProperties");
  std::vector<VkLayerProperties> layers(count);
  vk_check(vkEnumerateInstanceLayerProperties(&count, layers.data()), "vkEnumerateInstanceLayerProperties");
  for (const VkLayerProperties& layer : layers)
    if (std::strcmp(layer.layerName, validation_layer) == 0) return;
  throw file_error("Vulkan", std::string("the layer ") + validation_layer + " (Debian: vulkan-validationlayers)",
                   "none of that name");
}

void create_instance(Device& device, const DeviceOptions& options) {
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "sinew";
  application.apiVersion = VK_API_VERSION_1_3;

  const VkValidationFeatureEnableEXT enabled = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(*device.messages);
  VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
  features.pNext = &messenger;
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = &enabled;

  std::vector<const char*> extensions = options.instance_extensions;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  if (options.validation) {
    require_validation_layer();
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    info.pNext = &features;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &validation_layer;
  }
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();

  const VkResult result = vkCreateInstance(&info, nullptr, &device.instance);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
    throw file_error("Vulkan", "a driver (Debian: mesa-vulkan-drivers)", "none");
  if (result == VK_ERROR_EXTENSION_NOT_PRESENT)
    throw file_error("Vulkan", "a driver that can draw to a window", "none");
  vk_check(result, "vkCreateInstance");

  if (options.validation) {
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(device.instance, "vkCreateDebugUtilsMessengerEXT"));
    vk_check(create(device.instance, &messenger, nullptr, &device.messenger), "vkCreateDebugUtilsMessengerEXT");
  }
}

/// What all shaders and passes rely on; every desktop GPU of Vulkan 1.3 has it.
struct Features {
  VkPhysicalDeviceVulkan13Features vulkan13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceVulkan12Features vulkan12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceFeatures2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};

  Features() {
    vulkan12.pNext = &vulkan13;
    all.pNext = &vulkan12;
  }
};

bool has_features(VkPhysicalDevice physical) {
  Features found;
  vkGetPhysicalDeviceFeatures2(physical, &found.all);
  return found.vulkan13.synchronization2 && found.vulkan12.bufferDeviceAddress && found.vulkan12.scalarBlockLayout &&
         found.vulkan13.maintenance4 && found.all.features.largePoints && found.all.features.geometryShader &&
         found.all.features.shaderInt64;
}

/// The family that does everything; -1 where there is none.
int queue_family(const Device& device, VkPhysicalDevice physical) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  for (std::uint32_t i = 0; i < count; ++i) {
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    if ((families[i].queueFlags & wanted) != wanted) continue;
    VkBool32 presents = VK_TRUE;
    if (device.surface != VK_NULL_HANDLE)
      vk_check(vkGetPhysicalDeviceSurfaceSupportKHR(physical, i, device.surface, &presents),
               "vkGetPhysicalDeviceSurfaceSupportKHR");
    if (presents == VK_TRUE) return static_cast<int>(i);
  }
  return -1;
}

int preference(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return 3;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return 2;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return 1;
    default: return 0;
  }
}

void choose_physical_device(Device& device) {
  std::uint32_t count = 0;
  vk_check(vkEnumeratePhysicalDevices(device.instance, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> all(count);
  vk_check(vkEnumeratePhysicalDevices(device.instance, &count, all.data()), "vkEnumeratePhysicalDevices");

  const char* wanted = std::getenv("SINEW_VULKAN_DEVICE");
  std::string seen;
  int best = -1;
  for (VkPhysicalDevice physical : all) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(physical, &properties);
    seen += (seen.empty() ? "" : ", ") + std::string(properties.deviceName);
    if (wanted != nullptr && std::strstr(properties.deviceName, wanted) == nullptr) continue;
    if (properties.apiVersion < VK_API_VERSION_1_3 || !has_features(physical)) continue;
    const int family = queue_family(device, physical);
    if (family < 0 || preference(properties.deviceType) <= best) continue;
    best = preference(properties.deviceType);
    device.physical = physical;
    device.queue_family = static_cast<std::uint32_t>(family);
    device.name = properties.deviceName;
    device.software = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    device.limits = properties.limits;
  }
  if (best >= 0) return;
  const std::string expected = wanted != nullptr && !all.empty()
                                   ? "a device named like SINEW_VULKAN_DEVICE=" + quoted(wanted)
                                   : "a device of Vulkan 1.3 (Debian: mesa-vulkan-drivers has a software one)";
  throw file_error("Vulkan", expected, seen.empty() ? "none" : seen);
}

void create_logical_device(Device& device) {
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueFamilyIndex = device.queue_family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;

  Features wanted;
  wanted.vulkan13.synchronization2 = VK_TRUE;
  wanted.vulkan13.maintenance4 = VK_TRUE;  // sizes of workgroups by constants
  wanted.vulkan12.bufferDeviceAddress = VK_TRUE;
  wanted.vulkan12.scalarBlockLayout = VK_TRUE;
  wanted.all.features.shaderInt64 = VK_TRUE;  // addresses
  wanted.all.features.largePoints = VK_TRUE;
  wanted.all.features.geometryShader = VK_TRUE;  // gl_PrimitiveID in a fragment shader

  const char* swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  info.pNext = &wanted.all;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = device.surface != VK_NULL_HANDLE ? 1 : 0;
  info.ppEnabledExtensionNames = &swapchain;
  vk_check(vkCreateDevice(device.physical, &info, nullptr, &device.handle), "vkCreateDevice");
  vkGetDeviceQueue(device.handle, device.queue_family, 0, &device.queue);
  vkGetPhysicalDeviceMemoryProperties(device.physical, &device.memory);
}

}  // namespace

void vk_check(VkResult result, const char* call) {
  if (result >= 0) return;
  const char* found = "an error";
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY: found = "no memory left"; break;
    case VK_ERROR_OUT_OF_DEVICE_MEMORY: found = "no memory left on the device"; break;
    case VK_ERROR_DEVICE_LOST: found = "a device that no longer answers"; break;
    case VK_ERROR_INITIALIZATION_FAILED: found = "a driver that does not start"; break;
    default: break;
  }
  throw file_error("Vulkan", std::string(call) + " to succeed",
                   std::string(found) + " (" + std::to_string(static_cast<int>(result)) + ")");
}

std::vector<std::string> Messages::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(texts_, {});
}

void Messages::add(std::string text) {
  const std::lock_guard lock(mutex_);
  texts_.push_back(std::move(text));
}

Device::~Device() {
  if (handle != VK_NULL_HANDLE) {
    vkDeviceWaitIdle(handle);
    skin_pipeline.reset();
    vkDestroyDevice(handle, nullptr);
  }
  if (surface != VK_NULL_HANDLE) vkDestroySurfaceKHR(instance, surface, nullptr);
  if (messenger != VK_NULL_HANDLE) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(instance, messenger, nullptr);
  }
  if (instance != VK_NULL_HANDLE) vkDestroyInstance(instance, nullptr);
}

std::unique_ptr<Device> create_device(const DeviceOptions& options) {
  keep_drivers_loaded();
  auto device = std::make_unique<Device>();
  create_instance(*device, options);
  if (options.create_surface) device->surface = options.create_surface(device->instance);
  choose_physical_device(*device);
  create_logical_device(*device);
  device->skin_pipeline =
      std::make_shared<Pipeline>(create_compute_pipeline(*device, "skin.comp", sizeof(shared::SkinConstants)));
  return device;
}

void wait_idle(const Device& device) {
  vk_check(vkDeviceWaitIdle(device.handle), "vkDeviceWaitIdle");
}

}  // namespace sinew::gpu
