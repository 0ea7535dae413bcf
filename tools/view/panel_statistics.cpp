// What the last frame took and what is in memory.
#include <imgui.h>

#include <algorithm>

#include "tools/byte_size.h"
#include "tools/view/panel.h"

namespace voyager::view {
namespace {

void show_count(const char* name, uint64_t value) {
  ImGui::Text("%-10s %10llu", name, static_cast<unsigned long long>(value));
}

// A bar for each stage, as long as its share of the frame.
void show_stages(const VoyFrameStats& stats) {
  for (uint32_t i = 0; i < stats.stageCount; ++i) {
    const double share = stats.milliseconds[i] / std::max(stats.millisecondsTotal, 1e-6);
    ImGui::Text("%-9s %8.2f ms", voyStageName(static_cast<VoyStage>(i)), stats.milliseconds[i]);
    ImGui::SameLine();
    ImGui::ProgressBar(static_cast<float>(share), {-1, ImGui::GetTextLineHeight()}, "");
  }
}

void show_residency(const VoyStreamingStats& streaming) {
  ImGui::Text("resident %llu of %llu chunks needed",
              static_cast<unsigned long long>(streaming.neededChunks - streaming.missingChunks),
              static_cast<unsigned long long>(streaming.neededChunks));
  const double held = static_cast<double>(streaming.residentChunks) /
                      static_cast<double>(std::max<uint64_t>(streaming.chunkSlots, 1));
  ImGui::ProgressBar(static_cast<float>(held), {170, 0});
  ImGui::SameLine();
  ImGui::Text("of %s", tools::size_text(streaming.budgetBytes).c_str());
  if (streaming.seenMissingChunks > 0)
    ImGui::TextColored({1, 0.75f, 0.3f, 1}, "seen, not here: %llu chunks, %s",
                       static_cast<unsigned long long>(streaming.seenMissingChunks),
                       tools::size_text(streaming.missingBytes).c_str());
  else
    ImGui::Text("all that is seen is here");
}

}  // namespace

void show_statistics(const Session& session) {
  if (const auto& stats = session.stats()) {
    const auto& times = session.frame_times();
    if (!times.empty())
      ImGui::PlotLines("##times", times.data(), static_cast<int>(times.size()), 0, nullptr, 0,
                       1.1f * *std::max_element(times.begin(), times.end()),
                       {ImGui::GetContentRegionAvail().x, 40});
    ImGui::Text("%.1f ms a frame, tau %.2f", stats->millisecondsTotal, stats->tau);
    if (stats->timeBudgetState == VOY_TIME_BUDGET_STATE_UNREACHABLE)
      ImGui::TextColored({1, 0.75f, 0.3f, 1}, "the time budget is out of reach");
    show_stages(*stats);
    show_count("cut", stats->cutSize);
    show_count("drawn", stats->splats);
    if (const auto& right = session.right_stats()) show_count("right", right->splats);
  }
  if (session.streaming()) show_residency(*session.streaming());
}

void show_detail_scale() {
  constexpr int kSteps = 60;
  constexpr float kWidth = 240, kHeight = 12;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  for (int i = 0; i < kSteps; ++i) {
    const float along = (static_cast<float>(i) + 0.5f) / kSteps;
    const Vec3f c = detail_colour(kFinestExtent * std::pow(kCoarsestExtent / kFinestExtent, along));
    const float x = corner.x + kWidth * static_cast<float>(i) / kSteps;
    ImGui::GetWindowDrawList()->AddRectFilled({x, corner.y},
                                              {x + kWidth / kSteps + 1, corner.y + kHeight},
                                              ImGui::GetColorU32({c.x, c.y, c.z, 1}));
  }
  ImGui::Dummy({kWidth, kHeight});
  constexpr const char* kLabels[] = {"1 cm", "10 cm", "1 m", "10 m"};
  for (int i = 0; i < 4; ++i) {
    if (i > 0) ImGui::SameLine(static_cast<float>(i) * kWidth / 3);
    ImGui::TextUnformatted(kLabels[i]);
  }
  ImGui::TextDisabled("merged Gaussians; grey: the scene's own");
}

}  // namespace voyager::view
