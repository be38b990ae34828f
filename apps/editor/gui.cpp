#include "apps/editor/gui.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_vulkan.h>

#include <algorithm>

namespace sinew::editor {

namespace {

Fonts loaded;

void set_keys(ImGuiIO& io) {
  const std::pair<int, int> keys[] = {{ImGuiKey_Tab, GLFW_KEY_TAB},
                                      {ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
                                      {ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
                                      {ImGuiKey_UpArrow, GLFW_KEY_UP},
                                      {ImGuiKey_DownArrow, GLFW_KEY_DOWN},
                                      {ImGuiKey_PageUp, GLFW_KEY_PAGE_UP},
                                      {ImGuiKey_PageDown, GLFW_KEY_PAGE_DOWN},
                                      {ImGuiKey_Home, GLFW_KEY_HOME},
                                      {ImGuiKey_End, GLFW_KEY_END},
                                      {ImGuiKey_Insert, GLFW_KEY_INSERT},
                                      {ImGuiKey_Delete, GLFW_KEY_DELETE},
                                      {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
                                      {ImGuiKey_Space, GLFW_KEY_SPACE},
                                      {ImGuiKey_Enter, GLFW_KEY_ENTER},
                                      {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
                                      {ImGuiKey_KeyPadEnter, GLFW_KEY_KP_ENTER},
                                      {ImGuiKey_A, GLFW_KEY_A},
                                      {ImGuiKey_C, GLFW_KEY_C},
                                      {ImGuiKey_V, GLFW_KEY_V},
                                      {ImGuiKey_X, GLFW_KEY_X},
                                      {ImGuiKey_Y, GLFW_KEY_Y},
                                      {ImGuiKey_Z, GLFW_KEY_Z}};
  for (const auto& [key, code] : keys) io.KeyMap[key] = code;
}

void check(VkResult result) {
  gpu::vk_check(result, "Dear ImGui");
}

}  // namespace

const Fonts& fonts() {
  return loaded;
}

Gui::Gui(Window& window, const gpu::Device& device, VkRenderPass pass, std::uint32_t image_count)
    : window_(window), device_(device), pass_(pass), image_count_(std::max(2u, image_count)), last_frame_(now()) {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
  info.maxSets = 1;
  info.poolSizeCount = 1;
  info.pPoolSizes = &size;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  gpu::vk_check(vkCreateDescriptorPool(device.handle, &info, nullptr, &pool), "vkCreateDescriptorPool");
  pool_ = {device.handle, pool, vkDestroyDescriptorPool};

  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_HasMouseCursors;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  io.ConfigDragClickToInputText = true;
  set_keys(io);
  io.ClipboardUserData = this;
  io.GetClipboardTextFn = [](void* data) {
    auto& gui = *static_cast<Gui*>(data);
    gui.clipboard_ = gui.window_.clipboard();
    return gui.clipboard_.c_str();
  };
  io.SetClipboardTextFn = [](void* data, const char* text) { static_cast<Gui*>(data)->window_.set_clipboard(text); };
}

Gui::~Gui() {
  gpu::wait_idle(device_);
  if (backend_) ImGui_ImplVulkan_Shutdown();
  ImGui::DestroyContext();
  loaded = {};
}

void Gui::start_backend() {
  // The backend of 1.86 makes its font texture once in a life: new fonts are a new backend.
  gpu::wait_idle(device_);
  if (backend_) ImGui_ImplVulkan_Shutdown();
  ImGui_ImplVulkan_InitInfo info{};
  info.Instance = device_.instance;
  info.PhysicalDevice = device_.physical;
  info.Device = device_.handle;
  info.QueueFamily = device_.queue_family;
  info.Queue = device_.queue;
  info.DescriptorPool = pool_;
  info.MinImageCount = 2;
  info.ImageCount = image_count_;
  info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
  info.CheckVkResultFn = check;
  ImGui_ImplVulkan_Init(&info, pass_);
  backend_ = true;
  gpu::run_once(device_, [](VkCommandBuffer commands) { ImGui_ImplVulkan_CreateFontsTexture(commands); });
  ImGui_ImplVulkan_DestroyFontUploadObjects();
}

void Gui::use(const Theme& theme, float scale) {
  use_theme(theme, scale);
  if (scale == font_scale_) return;
  loaded = load_fonts(scale, pictures_);
  font_scale_ = scale;
  start_backend();
}

void Gui::show_pictures(std::vector<gpu::Picture> pictures) {
  pictures_ = std::move(pictures);
  font_scale_ = 0;
}

void Gui::feed(const InputEvent& event) {
  using What = InputEvent::What;
  ImGuiIO& io = ImGui::GetIO();
  switch (event.what) {
    case What::Move: io.MousePos = {static_cast<float>(event.x), static_cast<float>(event.y)}; break;
    case What::Button: io.MouseDown[event.code] = event.action != 0; break;
    case What::Wheel:
      io.MouseWheelH += static_cast<float>(event.x);
      io.MouseWheel += static_cast<float>(event.y);
      break;
    case What::Text: io.AddInputCharacter(static_cast<unsigned>(event.code)); break;
    case What::Focus:
      io.AddFocusEvent(event.action != 0);
      if (event.action == 0) std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
      break;
    case What::Key:
      io.KeysDown[event.code] = event.action != 0;
      io.KeyCtrl = io.KeysDown[GLFW_KEY_LEFT_CONTROL] || io.KeysDown[GLFW_KEY_RIGHT_CONTROL];
      io.KeyShift = io.KeysDown[GLFW_KEY_LEFT_SHIFT] || io.KeysDown[GLFW_KEY_RIGHT_SHIFT];
      io.KeyAlt = io.KeysDown[GLFW_KEY_LEFT_ALT] || io.KeysDown[GLFW_KEY_RIGHT_ALT];
      break;
    case What::Drop:
    case What::Resize:
    case What::Close: break;
  }
}

void Gui::begin(VkExtent2D size) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(size.width), static_cast<float>(size.height)};
  const double time = now();
  io.DeltaTime = static_cast<float>(std::clamp(time - last_frame_, 1e-4, 0.25));
  last_frame_ = time;
  ImGui_ImplVulkan_NewFrame();
  ImGui::NewFrame();
}

void Gui::draw(VkCommandBuffer commands) {
  ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
}

CursorShape Gui::cursor() {
  switch (ImGui::GetMouseCursor()) {
    case ImGuiMouseCursor_TextInput: return CursorShape::Text;
    case ImGuiMouseCursor_ResizeEW: return CursorShape::Horizontal;
    case ImGuiMouseCursor_ResizeNS: return CursorShape::Vertical;
    case ImGuiMouseCursor_Hand: return CursorShape::Hand;
    default: return CursorShape::Arrow;
  }
}

}  // namespace sinew::editor
