#include "gui.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "failure.h"
#include "frames_in_flight.h"
#include "submission.h"

namespace host {
namespace {

UniqueDescriptorPool make_pool(VkDevice device) {
  const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
  VkDescriptorPoolCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
  info.maxSets = 1;
  info.poolSizeCount = 1;
  info.pPoolSizes = &size;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(device, &info, nullptr, &pool), "vkCreateDescriptorPool");
  return {device, pool};
}

}  // namespace

Gui::Gui(const Device& device, const Window* window, VkRenderPass pass)
    : in_window_(window != nullptr), pool_(make_pool(device.get())) {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  if (window) ImGui_ImplGlfw_InitForVulkan(window->get(), true);
  ImGui_ImplVulkan_InitInfo info = {};
  info.Instance = device.instance();
  info.PhysicalDevice = device.physical();
  info.Device = device.get();
  info.QueueFamily = device.queue_family();
  info.Queue = device.queue();
  info.DescriptorPool = pool_.get();
  info.MinImageCount = info.ImageCount = kFramesInFlight;
  info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
  ImGui_ImplVulkan_Init(&info, pass);
  run_once(device.get(), device.queue(), device.queue_family(),
           [](VkCommandBuffer commands) { ImGui_ImplVulkan_CreateFontsTexture(commands); });
  ImGui_ImplVulkan_DestroyFontUploadObjects();
}

Gui::~Gui() {
  ImGui_ImplVulkan_Shutdown();
  if (in_window_) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

bool Gui::has_mouse() const {
  return ImGui::GetIO().WantCaptureMouse;
}
bool Gui::has_keyboard() const {
  return ImGui::GetIO().WantCaptureKeyboard;
}

void Gui::resize(VkExtent2D extent) {
  ImGui::GetIO().DisplaySize = {static_cast<float>(extent.width),
                                static_cast<float>(extent.height)};
}

void Gui::step_clock() {
  constexpr float kLeast = 1e-6f;  // Dear ImGui takes no frame without length
  const auto now = std::chrono::steady_clock::now();
  const std::chrono::duration<float> passed = now - std::exchange(last_, now);
  ImGui::GetIO().DeltaTime = std::max(passed.count(), kLeast);
}

void Gui::begin() {
  ImGui_ImplVulkan_NewFrame();
  in_window_ ? ImGui_ImplGlfw_NewFrame() : step_clock();
  ImGui::NewFrame();
}

void Gui::end() {
  ImGui::Render();
}

void Gui::record(VkCommandBuffer commands) const {
  ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
}

}  // namespace host
