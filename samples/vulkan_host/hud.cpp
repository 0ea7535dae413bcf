#include "hud.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include "failure.h"
#include "frame_log.h"
#include "mode_names.h"
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

void show_device(const Device& device, const VoyagerLayer& voyager) {
  const VoyVulkanCapabilities& vulkan = voyager.vulkan_capabilities();
  ImGui::Text("%s", device.name().c_str());
  ImGui::Text("backend %s, sharing %s, sync %s", backend_name(voyager.capabilities().backend),
              sharing_name(vulkan.sharing), sync_name(vulkan.sync));
  if (vulkan.why[0]) ImGui::TextWrapped("%s", vulkan.why);
}

void show_stats(const VoyFrameStats& stats) {
  for (uint32_t i = 0; i < stats.stageCount; ++i)
    ImGui::Text("%-10s %7.2f ms", voyStageName(static_cast<VoyStage>(i)), stats.milliseconds[i]);
  ImGui::Text("%-10s %7.2f ms", "total", stats.millisecondsTotal);
  const auto count = [](const char* name, uint64_t value) {
    ImGui::Text("%-10s %10llu", name, static_cast<unsigned long long>(value));
  };
  count("cut", stats.cutSize);
  count("entered", stats.entered);
  count("left", stats.left);
  count("tested", stats.nodesTested);
  count("splats", stats.splats);
  count("pairs", stats.pairsAfter);
}

void show_controls(HudState& state) {
  ImGui::SliderFloat("tau, px", &state.tau, 0.5f, 30.0f, "%.2f", ImGuiSliderFlags_Logarithmic);
  ImGui::Checkbox("steer tau by time", &state.steer_tau);
  ImGui::SliderFloat("budget, ms", &state.time_budget, 1.0f, 200.0f, "%.0f",
                     ImGuiSliderFlags_Logarithmic);
  ImGui::Checkbox("meshes", &state.look.mesh);
  int composite = static_cast<int>(state.look.composite);
  ImGui::RadioButton("depth limit", &composite, static_cast<int>(Composite::limit));
  ImGui::SameLine();
  ImGui::RadioButton("depth test", &composite, static_cast<int>(Composite::test));
  ImGui::SameLine();
  ImGui::RadioButton("no splats", &composite, static_cast<int>(Composite::none));
  state.look.composite = static_cast<Composite>(composite);
}

}  // namespace

Hud::Hud(const Device& device, const Window& window, VkRenderPass pass)
    : pool_(make_pool(device.get())) {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui_ImplGlfw_InitForVulkan(window.get(), true);
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
  upload_fonts(device);
}

Hud::~Hud() {
  ImGui_ImplVulkan_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Hud::upload_fonts(const Device& device) {
  const VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0,
                                             device.queue_family()};
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vkCreateCommandPool(device.get(), &pool_info, nullptr, &pool), "vkCreateCommandPool");
  const UniqueCommandPool owner(device.get(), pool);
  const VkCommandBufferAllocateInfo info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr,
                                            pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vkAllocateCommandBuffers(device.get(), &info, &commands), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin = {};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  ImGui_ImplVulkan_CreateFontsTexture(commands);
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  Submission(commands).submit(device.queue(), VK_NULL_HANDLE);
  device.wait_idle();
  ImGui_ImplVulkan_DestroyFontUploadObjects();
}

bool Hud::has_mouse() const {
  return ImGui::GetIO().WantCaptureMouse;
}
bool Hud::has_keyboard() const {
  return ImGui::GetIO().WantCaptureKeyboard;
}

void Hud::build(HudState& state, const Device& device, const VoyagerLayer& voyager,
                const VoyFrameStats* stats, const FlyCamera& camera) {
  ImGui_ImplVulkan_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  ImGui::SetNextWindowPos({12, 12}, ImGuiCond_FirstUseEver);
  ImGui::Begin("Voyager", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
  show_device(device, voyager);
  ImGui::Text("%.1f frames a second; speed %.3g m/s", static_cast<double>(ImGui::GetIO().Framerate),
              camera.speed());
  const double resident = static_cast<double>(voyager.scene().residentBytes) / 1e6;
  if (state.budget_megabytes > 0)
    ImGui::Text("scene %.1f of %.1f MB", resident, state.budget_megabytes);
  else
    ImGui::Text("scene %.1f MB", resident);
  ImGui::Separator();
  show_controls(state);
  ImGui::Separator();
  if (stats) show_stats(*stats);
  ImGui::TextDisabled("W A S D Q E, Shift; right button; wheel; C: next camera");
  ImGui::End();
  ImGui::Render();
}

void Hud::record(VkCommandBuffer commands) const {
  ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
}

}  // namespace host
