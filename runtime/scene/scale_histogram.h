#pragma once
// An estimate of METHOD §12's native pixel from the Gaussians alone. Where pictures show detail,
// training makes Gaussians about as small as a pixel and hardly any smaller across two of their
// axes: the third may be as thin as a surface is. So the pixel is taken to be the tenth percentile
// of the middle axis, of those Gaussians that can be seen. It is too large where a scene has few
// Gaussians for its size (bench/NOTES.md).
#include <array>
#include <cstdint>

#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

// Fainter Gaussians say little about the size at which a scene was seen.
inline constexpr float kVisibleLogit = -2.9444f;  // of an opacity of 1/20

// Sums over parts of a scene, in any order: the same for each way to take it apart.
class ScaleHistogram {
 public:
  void add(const GaussianCloud& cloud) { add(cloud, 0, cloud.size()); }
  void add(const GaussianCloud& cloud, size_t begin, size_t end);
  void add(const ScaleHistogram& other);
  // What was found; unknown where no Gaussian was counted.
  NativeScale estimate() const;

 private:
  // Natural logarithms from -21 to 14 in steps of 1/64: scales are 1e-9 to 1e6 m (sanitise.h).
  static constexpr int kLowest = -21, kSteps = 64, kBins = 35 * kSteps;
  std::array<uint64_t, kBins> counts_{};
};

NativeScale estimated_scale(const GaussianCloud& cloud);
// The cloud's own where it is known, else the estimate.
NativeScale known_scale(const GaussianCloud& cloud);

}  // namespace voyager
