#pragma once
// Where the eyes of a frame go, and what the host's Vulkan and the frame wait for.
#include <mutex>
#include <vector>

#include "plugin/call.h"
#include "plugin/field_name.h"
#include "plugin/objects.h"

namespace voyager {

struct EyeTarget {
  std::shared_ptr<TargetObject> object;
  uint32_t layer = 0;
  const VoyEyeDepthLimit* limit = nullptr;  // or NULL
};

// What messages call an eye.
FieldName eye_name(size_t eye);

// One an eye, checked: of the view's device and no larger than the view, all of one kind, no
// two the same image, and with `vulkan` exactly where they are Vulkan's. Throws ApiError.
std::vector<EyeTarget> checked_targets(Call& call, const VoyFrame& frame,
                                       const VoyVulkanFrame* vulkan, const ViewObject& view);

// They are the caller's while the result lives. Throws ApiError(BUSY).
std::vector<std::unique_lock<std::mutex>> claim(const std::vector<EyeTarget>& targets);

// Renders into rings, one or several: `frame` has an eye a target, but for what the rings know.
void render_into_rings(const std::vector<EyeTarget>& targets, const VoyVulkanFrame& vulkan,
                       ViewObject& view, FrameInput& frame);

}  // namespace voyager
