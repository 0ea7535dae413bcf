#pragma once
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

// Colours that were trained as linear values become sRGB's code values, which is what Gaussians are
// drawn and blended in: of all coefficients of the cloud's degree those that come nearest to the
// encoded colour, over all directions. Exact without view dependence. Blending linear values would
// give other colours where Gaussians overlap.
void encode_colours(GaussianCloud& cloud);

}  // namespace voyager
