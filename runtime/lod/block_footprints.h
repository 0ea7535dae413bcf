#pragma once
// METHOD §12: the footprint level of each block of Gaussians, from the cameras that a scene was
// trained with.
#include <span>

#include "runtime/scene/gaussian_cloud.h"
#include "runtime/scene/training_camera.h"

namespace voyager {

struct BlockFootprints {
  std::span<const TrainingCamera> cameras{};
  int unseen_level = 0;  // of a block that no camera sees
  // By Gaussian, of a scene that is baked again, or of inputs with levels of their own; asked
  // first. A block has the smallest pixel of its Gaussians.
  std::span<const uint8_t> known{};
};

// Of a block: that of the lower quartile of the native pixels of a few of its Gaussians, among the
// levels that cloud.native has. One that is too large blurs without bound what was seen from near;
// one that is too small takes away no more than training added. With the median a street whose
// blocks reach behind its houses looks worse than with one value for the scene (bench/NOTES.md).
// leaves: indices into the cloud. Depends on nothing but its arguments; thread-safe.
uint8_t footprint_level(const GaussianCloud& cloud, std::span<const uint32_t> leaves,
                        const BlockFootprints& footprints);

}  // namespace voyager
