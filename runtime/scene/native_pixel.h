#pragma once
// METHOD §12's native pixel p₀ from the cameras that a scene was trained with: depth / focal at
// each Gaussian, the least over the cameras that see it. A camera sees what is before it and inside
// its picture. What hides it from the camera is not asked, so that behind walls p₀ comes out too
// small.
#include <array>
#include <cstdint>
#include <span>

#include "runtime/scene/gaussian_cloud.h"
#include "runtime/scene/training_camera.h"

namespace voyager {

// Of the Gaussian at p, in metres; 0 where no camera sees it. A pixel with two different sides has
// the side of a square of the same area.
double native_pixel_at(const Vec3d& p, std::span<const TrainingCamera> cameras);

struct NativePixel {
  uint64_t looked_at = 0;  // Gaussians that are not too faint to see
  uint64_t seen = 0;       // of those, by at least one camera
  // Percentiles of those seen, metres; 0 where there are none.
  double second = 0, tenth = 0, median = 0, ninetieth = 0, ninety_eighth = 0;

  // With levels for the blocks of Gaussians (lod/block_footprints.h). The few Gaussians right
  // before a camera or far behind the scene count neither way: level 0 is the 98th percentile, or
  // less where the 2nd is further below it than levels reach. Where both are within one level, the
  // scene has the median. Unknown where no Gaussian was seen.
  NativeScale scale() const;
};

// Counts in bins of p₀, from blocks of a scene in any order: the result is the same for each way to
// take the scene apart, and each number of threads.
class NativePixelHistogram {
 public:
  // The cameras must outlive this. `gaussians` is how many the scene has: the work is Gaussians
  // times cameras, so only each k-th is looked at, kMost at most. A percentile is then off by less
  // than one in a hundred of the Gaussians.
  NativePixelHistogram(std::span<const TrainingCamera> cameras, uint64_t gaussians);

  // `first` is the place in the scene of the cloud's first Gaussian.
  void add(const GaussianCloud& cloud, uint64_t first);
  // Of the same scene and cameras.
  void add(const NativePixelHistogram& other);
  NativePixel find() const;

  static constexpr uint64_t kMost = 20'000;

 private:
  // Bins as wide as 1/64 of the power of two below them, so that no logarithm is needed, whose last
  // bits differ between machines.
  static constexpr int kSteps = 64, kLowest = -30, kHighest = 20;  // powers of two, metres
  static constexpr size_t kBins = size_t{kHighest - kLowest} * kSteps;

  double percentile(double share) const;

  std::span<const TrainingCamera> cameras_;
  uint64_t step_;
  uint64_t looked_at_ = 0, seen_ = 0;
  std::array<uint32_t, kBins> counts_{};
};

NativePixel native_pixel(std::span<const TrainingCamera> cameras, const GaussianCloud& cloud);

}  // namespace voyager
