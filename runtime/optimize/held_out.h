#pragma once
// How near cuts are to the truth in views that nothing was learned from.
#include <span>
#include <vector>

#include "runtime/optimize/optimize.h"
#include "runtime/optimize/training_views.h"

namespace voyager {

// The PSNR of view `view` for a cut with `share` of the leaves, interpolated in log(share).
// `looked` is by ascending τ. A share below the coarsest cut's has the coarsest cut's PSNR.
double psnr_with_share(std::span<const HeldOut> looked, size_t view, double share);

class HeldOutViews {
 public:
  // The views are first to first + count - 1, which nothing learns from. Shares are shares of
  // looked_at leaves. all_leaves also counts the leaves around them, which every cut has.
  HeldOutViews(const TrainingViews& views, uint32_t first, uint32_t count, size_t looked_at,
               size_t all_leaves)
      : views_(views),
        first_(first),
        count_(count),
        looked_at_(looked_at),
        around_(all_leaves - looked_at) {}

  // Looks at the default τ, twice and five times it.
  std::vector<HeldOut> look(NodeTrainer& trainer) const;
  // Tries τ, of which each has a 2τ + 1 that is ∛2 times that of the one before. Returns the last
  // one before the pictures of a cut have over half a dB less than every leaf's, on average over
  // the nearer half of the views or over the farther half.
  double best_tau(NodeTrainer& trainer) const;
  // How many pictures look() draws, and how many best_tau() draws at most.
  uint32_t pictures_of_look() const;
  uint32_t pictures_of_best_tau() const;

 private:
  TrainingView view(uint32_t i, double tau) const;
  double psnr_of(const TrainingView& view, const TrainingError& error) const;

  const TrainingViews& views_;
  uint32_t first_, count_;
  size_t looked_at_, around_;
};

}  // namespace voyager
