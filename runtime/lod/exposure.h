#pragma once
// How much of each Gaussian is seen from outside, in the midst of its neighbours: what is
// hidden behind others wherever one looks from may be coarse.
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/lod/baked_scene.h"

namespace voyager {

// Of a Gaussian: the root of the mean over directions of T², weighted by what it covers, where T
// is the transmittance of the block's Gaussians before it. In steps of 1/255, at least
// kLeastExposure: a viewer may stand where no direction from outside leads.
inline constexpr uint8_t kLeastExposure = 13;
constexpr double exposure_of(uint8_t steps) {
  return steps / 255.0;
}

// Of the Gaussians `leaves` of the cloud, drawn by themselves along fixed directions; written to
// `exposure`, by Gaussian. Depends on nothing but its arguments; thread-safe.
void find_exposure(const GaussianCloud& cloud, const std::array<double, 3>& origin,
                   std::span<const uint32_t> leaves, std::span<uint8_t> exposure);

}  // namespace voyager
