#pragma once
#include "runtime/frame/backend.h"
#include "voyager/voyager.h"

namespace voyager {

// The pure part of voyRenderFrame: what the host says about the frame, checked
// and in the runtime's terms; tau is the view's and left to the caller. Throws
// ApiError naming the field, what was found and what was expected. `image` gives
// the camera its size; `instances` is how many the view has.
FrameInput frame_input(const VoyFrame& frame, const VoyFrameEye& eye, const Image& image,
                       uint32_t instances);

}  // namespace voyager
