#pragma once
#include <string>

#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

// Puts `more` behind `cloud`, in order; both give their reports to the sum. The
// lower SH degree is padded with zeros. Throws Error(refused_input), naming
// `more_name`, where the origins or the filters of the training differ: positions
// could not keep their words, nor splats their shape.
void append(GaussianCloud& cloud, GaussianCloud&& more, const std::string& more_name);

// What append() asks of two inputs, for builders that never hold either.
void require_alike(const std::array<double, 3>& origin, const NativeScale& native,
                   const std::array<double, 3>& more_origin, const NativeScale& more_native,
                   const std::string& more_name);
void add(ImportReport& sum, const ImportReport& more);

}  // namespace voyager
