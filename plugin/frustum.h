#pragma once
#include <string>

#include "voyager/voyager.h"

namespace voyager {

// Throws ApiError, naming the side of `name`, for tangents that VoyFrustum excludes.
void check_frustum(const VoyFrustum& frustum, const std::string& name);

}  // namespace voyager
