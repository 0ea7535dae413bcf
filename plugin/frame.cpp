#include <algorithm>
#include <iterator>

#include "plugin/call.h"
#include "plugin/claim.h"
#include "plugin/depth_limit.h"
#include "plugin/frame_input.h"
#include "plugin/structs.h"

using namespace voyager;

namespace {

static_assert(int{VOY_STAGE_RESOLVE} + 1 == int{kStageCount});
static_assert(int{kStageCount} <= VOY_MAX_STAGES);

void check_size(const Image& image, const ViewObject& view) {
  if (image.width > view.max_width || image.height > view.max_height)
    refuse("frame.eyes[0].target: found " + std::to_string(image.width) + " x " +
           std::to_string(image.height) + " pixels, expected at most the view's " +
           std::to_string(view.max_width) + " x " + std::to_string(view.max_height));
}

VoySearch search_of(const FrameStats& stats) {
  if (!stats.searched) return VOY_SEARCH_AUTO;
  switch (stats.search) {
    case Search::exhaustive:
      return VOY_SEARCH_EXHAUSTIVE;
    case Search::streaming:
      return VOY_SEARCH_STREAMING;
    case Search::temporal:
      return VOY_SEARCH_TEMPORAL;
    case Search::temporal_visit:
      break;
  }
  return VOY_SEARCH_TEMPORAL_VISIT;
}

void fill(VoyFrameStats& out, const FrameStats& in) {
  out.frameIndex = in.frame_index;
  out.search = search_of(in);
  out.tauStar = in.tau_star;
  for (int i = 0; i < 3; ++i) out.cutCentre[i] = in.cut_centre[i];
  out.stageCount = kStageCount;
  out.nodesTotal = in.nodes_total;
  out.nodesTested = in.nodes_tested;
  out.subtreesVisited = in.subtrees_visited;
  out.chunksRead = in.chunks_read;
  out.bytesRead = in.bytes_read;
  out.cutSize = in.cut_size;
  out.entered = in.entered;
  out.left = in.left;
  out.splats = in.splats;
  out.pairsBefore = in.pairs_before;
  out.pairsAfter = in.pairs_after;
  out.pairsDropped = in.pairs_dropped;
  std::copy(std::begin(in.milliseconds), std::end(in.milliseconds), out.milliseconds);
  out.millisecondsTotal = in.total_milliseconds;
}

// What the frame's target asks of it.
vulkan::FrameSync checked_sync(const TargetObject& target, const VoyVulkanFrame* frame,
                               uint32_t layer) {
  if (target.ring == nullptr) {
    if (frame != nullptr)
      throw ApiError(VOY_ERROR_INVALID_STRUCTURE,
                     "frame.next: found a VoyVulkanFrame for a target of HOST_MEMORY");
    check_count(layer, 0, 0, "frame.eyes[0].layer");
    return {};
  }
  if (frame == nullptr)
    refuse("frame.next: found no VoyVulkanFrame, expected one for a target of VULKAN");
  check_count(frame->imageIndex, 0, target.ring->desc().images - 1, "VoyVulkanFrame.imageIndex");
  check_count(frame->reserved, 0, 0, "VoyVulkanFrame.reserved");
  check_count(layer, 0, target.ring->desc().layers - 1, "frame.eyes[0].layer");
  return {frame->waitValue, frame->signalValue};
}

// Rings that are gone make room for others.
void keep_ring(std::vector<std::weak_ptr<vulkan::Ring>>& rings,
               const std::shared_ptr<vulkan::Ring>& ring) {
  std::erase_if(rings, [&](const auto& kept) { return kept.expired() || kept.lock() == ring; });
  rings.push_back(ring);
}

struct RingPlace {
  uint32_t image, layer;
};

void render_into(vulkan::Ring& ring, View& view, FrameInput& input, const RingPlace& at,
                 const vulkan::FrameSync& sync, bool limited) {
  Image image = ring.begin_frame(at.image, at.layer, sync);
  input.depth_wanted = ring.desc().depth;
  if (limited && input.limits.values == nullptr) {
    image.external.limited = image.external.ring != nullptr;
    ring.set_limits(at.image, at.layer, input.limits);
  }
  view.render(input, image);
  ring.end_frame(sync);
}

}  // namespace

VoyResult voyRenderFrame(VoyView view, const VoyFrame* frame) {
  return guarded("voyRenderFrame", [&](Call& call) {
    const auto object = call.use<ViewObject>(view);
    const VoyVulkanFrame* vulkan = nullptr;
    check_structure(frame, VOY_STRUCTURE_TYPE_FRAME, "VoyFrame",
                    Extension{VOY_STRUCTURE_TYPE_VULKAN_FRAME, vulkan});
    check_count(frame->eyeCount, 1, 1, "frame.eyeCount");
    check_pointer(frame->eyes, "frame.eyes");
    const VoyFrameEye& eye = frame->eyes[0];
    const VoyEyeDepthLimit* limit = nullptr;
    check_structure(&eye, VOY_STRUCTURE_TYPE_FRAME_EYE, "frame.eyes[0]",
                    Extension{VOY_STRUCTURE_TYPE_EYE_DEPTH_LIMIT, limit});
    const auto target = call.use<TargetObject>(eye.target);
    if (target->parent() != object->parent())
      refuse("frame.eyes[0].target: found a target of another device, expected the view's");
    check_size(target->image, *object);
    const vulkan::FrameSync sync = checked_sync(*target, vulkan, eye.layer);
    FrameInput input = frame_input(*frame, eye, target->image, object->instances);
    input.limits = depth_limits(limit, target->image, target->ring.get());

    const auto view_lock = claim(*object);
    const auto target_lock = claim_object(*target, "frame.eyes[0].target");
    input.tau = object->tau;
    if (target->ring == nullptr) {
      object->view->render(input, target->image);
      return VOY_SUCCESS;
    }
    keep_ring(object->rings, target->ring);
    render_into(*target->ring, *object->view, input, {vulkan->imageIndex, eye.layer}, sync,
                limit != nullptr);
    return VOY_SUCCESS;
  });
}

VoyResult voyGetFrameStats(VoyView view, VoyFrameStats* stats) {
  return guarded("voyGetFrameStats", [&](Call& call) {
    const auto object = call.use<ViewObject>(view);
    check_structure(stats, VOY_STRUCTURE_TYPE_FRAME_STATS, "VoyFrameStats");
    const auto frame = claim(*object);
    check_has_frame(*object);
    VoyFrameStats found = {};
    found.type = VOY_STRUCTURE_TYPE_FRAME_STATS;
    fill(found, object->view->stats());
    *stats = found;
    return VOY_SUCCESS;
  });
}
