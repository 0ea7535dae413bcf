#pragma once
// Numbers of a .rad's properties as words of Gaussians.
#include <cstddef>
#include <span>

#include "runtime/scene/gaussian_cloud.h"
#include "runtime/scene/import/rad/property.h"

namespace voyager::rad {

// Fills what the property says of the cloud's Gaussians, whose arrays have their sizes. `planes`:
// its planes for as many Gaussians, with differences added up. child_count and child_start say
// nothing of them.
void decode_property(const Property& property, std::span<const std::byte> planes,
                     GaussianCloud& cloud);

}  // namespace voyager::rad
