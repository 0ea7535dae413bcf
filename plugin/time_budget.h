#pragma once
#include "plugin/objects.h"

namespace voyager {

// Throws ApiError naming the field, what was found and what was expected.
void check_time_budget(const VoyTimeBudget& budget);

// A checked one. Throws ApiError(VOY_ERROR_UNSUPPORTED) where the view draws no cut.
void set_time_budget(ViewObject& view, const VoyTimeBudget& budget);

}  // namespace voyager
