#pragma once
#include "plugin/field_name.h"
#include "runtime/frame/backend.h"
#include "voyager/voyager.h"
#include "vulkan_interop/ring.h"

namespace voyager {

// name: of the structure that has them, in messages. Throws ApiError, as the next does.
DepthEncoding checked_encoding(const VoyDepthEncoding& encoding, double near_z, double far_z,
                               const FieldName& name);

// What the host says of its own geometry's depth (NULL: nothing), checked. ring: of the
// target, or NULL; where it has the depth, the result has no values. eye: its name.
DepthLimits depth_limits(const VoyEyeDepthLimit* limit, const Image& image,
                         const vulkan::Ring* ring, const FieldName& eye);

}  // namespace voyager
