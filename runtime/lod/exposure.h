#pragma once
// What neighbours leave to be seen of a Gaussian, and what would show in its place: where much
// is hidden, or what is behind looks the same, coarse is good enough.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime/lod/baked_scene.h"
#include "runtime/lod/merge.h"

namespace voyager {

// In steps of 1/255. seen: the root of the mean over directions of T², weighted by what the
// Gaussian covers, where T is the transmittance of the block's Gaussians before it; at least
// kLeastSeen, since a viewer may stand where no direction from outside leads. contrast: of its
// colour, without bands, to what would be seen without it, root mean square; 0.2 where nothing is
// known of that.
struct ExposureCode {
  uint8_t seen, contrast;

  bool operator==(const ExposureCode&) const = default;
};
inline constexpr uint8_t kLeastSeen = 13;

constexpr Exposure exposure_of(ExposureCode code) {
  return {static_cast<float>(code.seen) / 255, static_cast<float>(code.contrast) / 255, 0};
}

// What a leaf counts for where it is merged: METHOD §2's weight as it is drawn, with its footprint
// (metres²), as far as it is seen. A colour that others hide is not seen from afar either.
inline float shown_weight(Gaussian leaf, const Exposure& exposure, double footprint) {
  leaf.scale = widened(leaf.scale, static_cast<float>(footprint));
  return static_cast<float>(merge_weight(leaf) * double{exposure.seen});
}

// Of several as one, with these weights.
inline Exposure mean_exposure(std::span<const Exposure> of, std::span<const double> weights) {
  double total = 0, seen = 0, shown = 0, contrast = 0;
  for (const double weight : weights) total += weight;
  for (size_t i = 0; i < of.size(); ++i) {
    const double share = total > 0 ? weights[i] / total : 1 / static_cast<double>(of.size());
    const double s = double{of[i].seen}, c = double{of[i].contrast};
    seen += share * s;
    shown += share * s * s;
    contrast += share * s * s * c * c;
  }
  return {static_cast<float>(seen), static_cast<float>(std::sqrt(contrast / shown)),
          static_cast<float>(total)};
}

// Of the Gaussians `leaves` of the cloud, drawn by themselves along fixed directions; written to
// `exposure`, by Gaussian. Depends on nothing but its arguments; thread-safe.
void find_exposure(const GaussianCloud& cloud, const std::array<double, 3>& origin,
                   std::span<const uint32_t> leaves, std::span<ExposureCode> exposure);

}  // namespace voyager
