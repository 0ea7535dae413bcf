#pragma once
#include "runtime/frame/backend.h"
#include "voyager/voyager.h"

namespace voyager {

// What the host says of its own geometry's depth (NULL: nothing), checked. Throws ApiError.
DepthLimits depth_limits(const VoyEyeDepthLimit* limit, const Image& image);

}  // namespace voyager
