#include "frame_log.h"

#include "files.h"
#include "mode_names.h"

namespace host {

void FrameLog::add(const VoyagerLayer* voyager) {
  if (path_.empty()) return;
  const auto now = std::chrono::steady_clock::now();
  nlohmann::json frame = {
      {"host_ms", std::chrono::duration<double, std::milli>(now - last_).count()}};
  last_ = now;
  if (voyager) {
    const VoyFrameStats stats = voyager->stats();
    frame["frame"] = stats.frameIndex;  // the last that has ended, where frames overlap
    frame["tau"] = stats.tau;
    frame["time_budget_ms"] = stats.millisecondsBudget;  // 0: none
    frame["cut"] = stats.cutSize;
    frame["splats"] = stats.splats;
    frame["nodes_tested"] = stats.nodesTested;
    for (uint32_t i = 0; i < stats.stageCount; ++i)
      frame["ms"][voyStageName(static_cast<VoyStage>(i))] = stats.milliseconds[i];
    frame["total_ms"] = stats.millisecondsTotal;
    frame["resident_bytes"] = voyager->scene().residentBytes;
    if (const auto streaming = voyager->streaming())
      frame["streaming"] = {{"budget_bytes", streaming->budgetBytes},
                            {"slots", streaming->chunkSlots},
                            {"resident_chunks", streaming->residentChunks},
                            {"missing_chunks", streaming->missingChunks},
                            {"arrived", streaming->arrivedChunks},
                            {"evicted", streaming->evictedChunks}};
  }
  frames_.push_back(std::move(frame));
}

void FrameLog::write(const Device& device, const VoyagerLayer& voyager) const {
  if (path_.empty()) return;
  const VoyVulkanCapabilities& vulkan = voyager.vulkan_capabilities();
  const nlohmann::json log = {{"vulkan_device", device.name()},
                              {"voyager_device", voyager.capabilities().deviceName},
                              {"backend", backend_name(voyager.capabilities().backend)},
                              {"sharing", sharing_name(vulkan.sharing)},
                              {"sync", sync_name(vulkan.sync)},
                              {"why", vulkan.why},
                              {"frames", frames_}};
  const std::string text = log.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  write_file(path_, std::as_bytes(std::span(text)));
}

}  // namespace host
