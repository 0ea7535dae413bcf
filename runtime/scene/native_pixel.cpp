#include "runtime/scene/native_pixel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "runtime/scene/scale_histogram.h"

namespace voyager {
namespace {

constexpr int kDroppedBits = 52 - 6;  // of a double's mantissa: 6 are left, which are 64 steps

uint64_t step_of(double x) {
  return std::bit_cast<uint64_t>(x) >> kDroppedBits;
}

double middle_of(uint64_t step) {
  return std::bit_cast<double>(step << kDroppedBits | uint64_t{1} << (kDroppedBits - 1));
}

// The area of the camera's pixel at p, +∞ where it does not see it.
double pixel_area(const Vec3d& p, const TrainingCamera& camera) {
  const Vec3d v = camera.world_to_view * (p - camera.position);
  // Multiplied by the depth, which is above zero: no division for what is outside.
  const double x = camera.fx * v.x + camera.cx * v.z, y = camera.fy * v.y + camera.cy * v.z;
  const bool inside =
      v.z > 0 && x >= 0 && x <= camera.width * v.z && y >= 0 && y <= camera.height * v.z;
  return inside ? v.z / camera.fx * (v.z / camera.fy) : std::numeric_limits<double>::infinity();
}

}  // namespace

double native_pixel_at(const Vec3d& p, std::span<const TrainingCamera> cameras) {
  double area = std::numeric_limits<double>::infinity();
  for (const TrainingCamera& camera : cameras) area = std::min(area, pixel_area(p, camera));
  return std::isfinite(area) ? std::sqrt(area) : 0;
}

NativeScale NativePixel::scale() const {
  if (seen == 0) return {};
  const double spread = ninety_eighth / second;
  if (spread * spread <= 2) return {NativeSource::cameras, median, kPixelVariance};
  const double reach = std::sqrt(1.0 / footprint_at(1.0, kFootprintLevels - 1));
  return {NativeSource::cameras, std::min(ninety_eighth, second * reach), kPixelVariance,
          kFootprintLevels};
}

NativePixelHistogram::NativePixelHistogram(std::span<const TrainingCamera> cameras,
                                           uint64_t gaussians)
    : cameras_(cameras), step_(std::max<uint64_t>((gaussians + kMost - 1) / kMost, 1)) {}

void NativePixelHistogram::add(const GaussianCloud& cloud, uint64_t first) {
  const Vec3d origin{cloud.origin[0], cloud.origin[1], cloud.origin[2]};
  const uint64_t skipped = (step_ - first % step_) % step_;  // to the next k-th
  for (uint64_t i = skipped; i < cloud.size(); i += step_) {
    if (!(cloud.opacity[i] >= kVisibleLogit)) continue;
    ++looked_at_;
    const float* p = cloud.position.data() + 3 * i;
    const double pixel = native_pixel_at(origin + Vec3d{p[0], p[1], p[2]}, cameras_);
    if (pixel == 0) continue;
    ++seen_;
    const double lowest = std::ldexp(1.0, kLowest);
    ++counts_[step_of(std::clamp(pixel, lowest, kMaxNativePixel)) - step_of(lowest)];
  }
}

void NativePixelHistogram::add(const NativePixelHistogram& other) {
  looked_at_ += other.looked_at_;
  seen_ += other.seen_;
  std::transform(counts_.begin(), counts_.end(), other.counts_.begin(), counts_.begin(),
                 std::plus<>());
}

double NativePixelHistogram::percentile(double share) const {
  if (seen_ == 0) return 0;
  uint64_t below = 0;
  size_t bin = 0;
  while (static_cast<double>(below += counts_[bin]) < share * static_cast<double>(seen_)) ++bin;
  return std::min(middle_of(step_of(std::ldexp(1.0, kLowest)) + bin), kMaxNativePixel);
}

NativePixel NativePixelHistogram::find() const {
  return {looked_at_,      seen_,           percentile(0.02), percentile(0.1),
          percentile(0.5), percentile(0.9), percentile(0.98)};
}

NativePixel native_pixel(std::span<const TrainingCamera> cameras, const GaussianCloud& cloud) {
  NativePixelHistogram histogram(cameras, cloud.size());
  histogram.add(cloud, 0);
  return histogram.find();
}

}  // namespace voyager
