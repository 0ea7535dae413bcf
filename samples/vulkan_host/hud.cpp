#include "hud.h"

#include <imgui.h>

#include "mode_names.h"

namespace host {
namespace {

void show_device(const Device& device, const VoyagerLayer& voyager) {
  const VoyVulkanCapabilities& vulkan = voyager.vulkan_capabilities();
  ImGui::Text("%s", device.name().c_str());
  ImGui::Text("backend %s, sharing %s, sync %s", backend_name(voyager.capabilities().backend),
              sharing_name(vulkan.sharing), sync_name(vulkan.sync));
  if (vulkan.why[0]) ImGui::TextWrapped("%s", vulkan.why);
}

void show_memory(const VoyagerLayer& voyager) {
  const auto megabytes = [](uint64_t bytes) { return static_cast<double>(bytes) / 1e6; };
  ImGui::Text("scene %.1f MB", megabytes(voyager.scene().residentBytes));
  const auto streaming = voyager.streaming();
  if (!streaming) return;
  ImGui::Text("streamed: %llu of %llu chunks in a budget of %.1f MB",
              static_cast<unsigned long long>(streaming->residentChunks),
              static_cast<unsigned long long>(streaming->chunkSlots),
              megabytes(streaming->budgetBytes));
  ImGui::Text("still to come: %.1f MB", megabytes(streaming->missingBytes));
}

void show_stats(const VoyFrameStats& stats) {
  for (uint32_t i = 0; i < stats.stageCount; ++i)
    ImGui::Text("%-10s %7.2f ms", voyStageName(static_cast<VoyStage>(i)), stats.milliseconds[i]);
  ImGui::Text("%-10s %7.2f ms", "total", stats.millisecondsTotal);
  if (stats.timeBudgetState == VOY_TIME_BUDGET_STATE_UNREACHABLE)
    ImGui::Text("late at the coarsest tau: this machine needs more time");
  const auto count = [](const char* name, uint64_t value) {
    ImGui::Text("%-10s %10llu", name, static_cast<unsigned long long>(value));
  };
  count("cut", stats.cutSize);
  count("entered", stats.nodesEntered);
  count("left", stats.nodesExited);
  count("tested", stats.nodesTested);
  count("splats", stats.splats);
  count("pairs", stats.pairsAfterFilter);
}

void show_controls(HudState& state, bool has_tree) {
  ImGui::SliderFloat("tau, px", &state.tau, 0.5f, 30.0f, "%.2f", ImGuiSliderFlags_Logarithmic);
  if (has_tree) ImGui::Checkbox("hold the frame time", &state.holds_time);
  if (has_tree)
    ImGui::SliderFloat("Voyager's part, ms", &state.frame_time, 1.0f, 200.0f, "%.1f",
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

void Hud::build(HudState& state, const Device& device, const VoyagerLayer& voyager,
                const VoyFrameStats* stats, const FlyCamera& camera) {
  gui_.begin();
  ImGui::SetNextWindowPos({12, 12}, ImGuiCond_FirstUseEver);
  ImGui::Begin("Voyager", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
  show_device(device, voyager);
  ImGui::Text("%.1f frames a second; speed %.3g m/s", static_cast<double>(ImGui::GetIO().Framerate),
              camera.speed());
  show_memory(voyager);
  ImGui::Separator();
  show_controls(state, voyager.has_tree());
  ImGui::Separator();
  if (stats) show_stats(*stats);
  ImGui::TextDisabled("W A S D Q E, Shift; right button; wheel; C: next camera");
  ImGui::End();
  gui_.end();
}

}  // namespace host
