#pragma once
#include "plugin/field_name.h"
#include "voyager/voyager.h"

namespace voyager {

// Throws ApiError, naming the side of `name`, for tangents that VoyFrustum excludes.
void check_frustum(const VoyFrustum& frustum, const FieldName& name);

}  // namespace voyager
