#pragma once
#include <string>

#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

// Puts `more` behind `cloud`, in order; both give their reports to the sum. The
// lower SH degree is padded with zeros. Throws Error(refused_input), naming
// `more_name`, where the origins or the antialiased flags differ: positions
// could not keep their words, nor splats their shape.
void append(GaussianCloud& cloud, GaussianCloud&& more, const std::string& more_name);

}  // namespace voyager
