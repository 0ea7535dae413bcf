#pragma once
#include <vector>

#include "plugin/field_name.h"
#include "runtime/frame/backend.h"
#include "runtime/math/reprojection.h"
#include "voyager/voyager.h"

namespace voyager {

// The pure part of voyRenderFrame: what the host says about the frame, checked
// and in the runtime's terms. Throws ApiError naming the field, what was found and
// what was expected.

// All but the eyes, and but tau and the instances, which are the view's.
FrameInput frame_input(const VoyFrame& frame);
// Of as many instances as the view has.
std::vector<InstancePose> frame_poses(const VoyInstancePose* instances, size_t count);
// field: what messages call the structure that both are in.
InstancePose instance_pose(const VoyPose& pose, double scale, const FieldName& field);
// None where all are the identity, which then costs what no poses cost.
std::vector<InstancePose> without_identities(std::vector<InstancePose> poses);
// Where an eye is and how far it sees, for a reprojection. field: what messages call it.
EyeView eye_view(const VoyPose& pose, const FieldName& pose_field, const VoyFrustum& frustum,
                 const FieldName& frustum_field);
// An eye that fills `image`, but for its limits. field: what messages call it.
FrameEye frame_eye(const VoyFrame& frame, const VoyFrameEye& eye, const Image& image,
                   const FieldName& field);

}  // namespace voyager
