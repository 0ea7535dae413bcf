#include <algorithm>
#include <iterator>

#include "plugin/call.h"
#include "plugin/claim.h"
#include "plugin/depth_limit.h"
#include "plugin/experiment.h"
#include "plugin/frame_input.h"
#include "plugin/frame_targets.h"
#include "plugin/streaming.h"
#include "plugin/structs.h"

using namespace voyager;

namespace {

static_assert(int{VOY_STAGE_RESOLVE} + 1 == int{kStageCount});
static_assert(int{kStageCount} <= VOY_MAX_STAGES);

VoyTimeBudgetState budget_of(const FrameStats& stats) {
  if (stats.time_budget == 0) return VOY_TIME_BUDGET_STATE_NONE;
  if (stats.total_milliseconds <= stats.time_budget) return VOY_TIME_BUDGET_STATE_HELD;
  return stats.tau_is_greatest ? VOY_TIME_BUDGET_STATE_UNREACHABLE : VOY_TIME_BUDGET_STATE_LATE;
}

void fill(VoyFrameStats& out, const FrameStats& in) {
  out.frameIndex = in.frame_index;
  out.tauStar = in.tau_star;
  for (int i = 0; i < 3; ++i) out.cutCenter[i] = in.cut_centre[i];
  out.stageCount = kStageCount;
  out.nodesTotal = in.nodes_total;
  out.nodesTested = in.nodes_tested;
  out.subtreesVisited = in.subtrees_visited;
  out.chunksRead = in.chunks_read;
  out.bytesRead = in.bytes_read;
  out.cutSize = in.cut_size;
  out.nodesEntered = in.entered;
  out.nodesExited = in.left;
  out.nodesUnrefined = in.missing;
  out.bytesStreamed = in.bytes_streamed;
  out.bytesNeeded = in.bytes_needed;
  out.splats = in.splats;
  out.pairsBeforeFilter = in.pairs_before;
  out.pairsAfterFilter = in.pairs_after;
  out.pairsDropped = in.pairs_dropped;
  std::copy(std::begin(in.milliseconds), std::end(in.milliseconds), out.milliseconds);
  out.millisecondsTotal = in.total_milliseconds;
  out.tau = in.tau;
  out.millisecondsBudget = in.time_budget;
  out.timeBudgetState = budget_of(in);
}

}  // namespace

VoyResult VOY_CALL voyRenderFrame(VoyView view, const VoyFrame* frame) {
  return guarded("voyRenderFrame", [&](Call& call) {
    const auto object = call.use<ViewObject>(view);
    const VoyVulkanFrame* vulkan = nullptr;
    const VoyFrameStreaming* streaming = nullptr;
    check_structure(frame, VOY_STRUCTURE_TYPE_FRAME, "VoyFrame",
                    Extension{VOY_STRUCTURE_TYPE_VULKAN_FRAME, vulkan},
                    Extension{VOY_STRUCTURE_TYPE_FRAME_STREAMING, streaming});
    check_count(frame->eyeCount, object->eyes, object->eyes, "frame.eyeCount");
    check_pointer(frame->eyes, "frame.eyes");
    const auto targets = checked_targets(call, *frame, vulkan, *object);
    FrameInput input = frame_input(*frame);
    for (uint32_t i = 0; i < frame->eyeCount; ++i) {
      const TargetObject& target = *targets[i].object;
      FrameEye eye = frame_eye(*frame, frame->eyes[i], target.image, eye_name(i));
      eye.limits = depth_limits(targets[i].limit, target.image, target.ring.get(), eye_name(i));
      input.eyes.push_back(eye);
    }

    const auto view_lock = claim(*object);
    const auto posed =
        static_cast<uint32_t>(frame->instances == nullptr ? 0 : object->scenes.size());
    check_count(frame->instanceCount, posed, posed, "frame.instanceCount");
    input.instances =
        frame->instances == nullptr ? object->poses : frame_poses(frame->instances, posed);
    input.looks = object->looks;
    const auto target_locks = claim(targets);
    input.tau = object->view->next_tau(object->tau);
    if (streaming != nullptr) {
      check_count(streaming->waitResident, 0, 1, "frame.next.waitResident");
      check_count(streaming->allowFallback, 0, 1, "frame.next.allowFallback");
      input.wait_resident = streaming->waitResident != 0;
      input.stand_in = streaming->allowFallback != 0;
    }
    for (const auto& scene : object->scenes) log_streaming(object->device(), *scene->scene);
    if (vulkan == nullptr)
      object->view->render(input);
    else
      render_into_rings(targets, *vulkan, *object, input);
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyGetFrameStats(VoyView view, VoyFrameStats* stats) {
  return guarded("voyGetFrameStats", [&](Call& call) {
    const auto object = call.use<ViewObject>(view);
    VoyExperimentStats* experiment = nullptr;
    check_structure(stats, VOY_STRUCTURE_TYPE_FRAME_STATS, "VoyFrameStats",
                    Extension{VOY_STRUCTURE_TYPE_EXPERIMENT_STATS, experiment});
    const auto frame = claim(*object);
    check_has_frame(*object);
    VoyFrameStats found = VOY_FRAME_STATS_INIT;
    found.next = stats->next;
    const FrameStats& last = object->view->stats();
    fill(found, last);
    *stats = found;
    if (experiment != nullptr) fill(*experiment, last);
    return VOY_SUCCESS;
  });
}
