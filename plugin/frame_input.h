#pragma once
#include <string>

#include "runtime/frame/backend.h"
#include "runtime/math/reprojection.h"
#include "voyager/voyager.h"

namespace voyager {

// The pure part of voyRenderFrame: what the host says about the frame, checked
// and in the runtime's terms. Throws ApiError naming the field, what was found and
// what was expected.

// All but the eyes and tau, which is the view's. `instances` is how many the view has.
FrameInput frame_input(const VoyFrame& frame, uint32_t instances);
// Where an eye is and how far it sees, for a reprojection. field: what messages call it.
EyeView eye_view(const VoyPose& pose, const std::string& pose_field, const VoyFrustum& frustum,
                 const std::string& frustum_field);
// An eye that fills `image`, but for its limits. field: what messages call it.
FrameEye frame_eye(const VoyFrame& frame, const VoyFrameEye& eye, const Image& image,
                   const std::string& field);

}  // namespace voyager
