#include "runtime/lod/block_footprints.h"

#include <algorithm>
#include <vector>

#include "runtime/scene/native_pixel.h"
#include "runtime/scene/scale_histogram.h"

namespace voyager {
namespace {

// Of a block, evenly spaced: the work is in proportion to them and to the cameras.
constexpr size_t kLookedAt = 32;

}  // namespace

uint8_t footprint_level(const GaussianCloud& cloud, std::span<const uint32_t> leaves,
                        const BlockFootprints& footprints) {
  if (!footprints.known.empty()) {
    uint8_t level = 0;
    for (const uint32_t leaf : leaves) level = std::max(level, footprints.known[leaf]);
    return level;
  }
  std::vector<uint32_t> visible;
  for (const uint32_t leaf : leaves)
    if (cloud.opacity[leaf] >= kVisibleLogit) visible.push_back(leaf);
  const size_t count = std::min(visible.size(), kLookedAt);
  std::vector<double> pixels;
  for (size_t i = 0; i < count; ++i) {
    const size_t leaf = visible[i * visible.size() / count];
    const float* p = &cloud.position[3 * leaf];
    const Vec3d mean{cloud.origin[0] + double{p[0]}, cloud.origin[1] + double{p[1]},
                     cloud.origin[2] + double{p[2]}};
    const double pixel = native_pixel_at(mean, footprints.cameras);
    if (pixel != 0) pixels.push_back(pixel);
  }
  if (pixels.empty()) return static_cast<uint8_t>(footprints.unseen_level);
  const auto quartile = pixels.begin() + static_cast<std::ptrdiff_t>((pixels.size() - 1) / 4);
  std::nth_element(pixels.begin(), quartile, pixels.end());
  return static_cast<uint8_t>(cloud.native.level_of(*quartile));
}

}  // namespace voyager
