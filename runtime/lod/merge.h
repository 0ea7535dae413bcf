#pragma once
// METHOD §2: a parent by moment matching over its children.
#include <span>

#include "runtime/math/gaussian.h"

namespace voyager {

// Opacity times surface. It telescopes: a parent's is the sum of its children's.
double merge_weight(const Gaussian& gaussian);

// One child as merge() sees it.
struct MergeInput {
  MergeInput() = default;
  MergeInput(const Gaussian& of, const float* coefficients)
      : gaussian(of), sh(coefficients), weight(merge_weight(of)) {}

  Gaussian gaussian;
  const float* sh;  // coefficients * 3
  double weight;    // what its share is found from; at least 0
};

struct Merged {
  GaussianWords words;  // log scale, unit rotation, linear opacity
};

// What a parent has to match, in double.
struct Moments {
  double weight;         // the sum of theirs
  Vec3d mean;            // by their weights; equally where all weights are 0
  double covariance[6];  // xx, xy, xz, yy, yz, zz
};
Moments moments(std::span<const MergeInput> children);

// Smallest scale of a merged Gaussian: kMinMergedScale metres and
// kMinMergedRatio of its largest scale (below that, the eigenvalues of a
// covariance in double are rounding noise of either sign).
inline constexpr double kMinMergedScale = 1e-9;
inline constexpr double kMinMergedRatio = 1e-8;

// At least one child; finite Gaussians with scales in [1e-9, 1e18] m. The
// opacity is the sum of the weights / A(s) with the scale as the words will be
// activated. With merge_weight() it is finite: the parent's covariance is at
// least w·Σ of its heaviest child, whose share w is ≥ 1/k, so the opacity grows
// by at most a factor k² from k children. Clustered trees weigh otherwise, and
// replace this opacity by the stand-in's (summarise.cpp).
// sh_out: coefficients * 3 floats; coefficients as of an SH degree up to 3.
// Thread-safe; allocates nothing.
Merged merge(std::span<const MergeInput> children, int coefficients, float* sh_out);

}  // namespace voyager
