#pragma once
// How near cuts are to the truth in views that nothing was learned from.
#include <span>
#include <vector>

#include "runtime/optimize/optimize.h"
#include "runtime/optimize/training_views.h"

namespace voyager {

// Of a view that was looked at with these τ, the least first: its PSNR with a cut of that share of
// the leaves. Between two cuts by the logarithm of their shares; beyond the coarsest as it; of
// all leaves with all of them.
double psnr_with_share(std::span<const HeldOut> looked, size_t view, double share);

class HeldOutViews {
 public:
  // first: of so many views, far behind those that are learned from. looked_at: leaves, of which
  // shares are; all_leaves: with those that are in every cut.
  HeldOutViews(const TrainingViews& views, uint32_t first, uint32_t count, size_t looked_at,
               size_t all_leaves)
      : views_(views),
        first_(first),
        count_(count),
        looked_at_(looked_at),
        around_(all_leaves - looked_at) {}

  // At the default τ, twice and five times it.
  std::vector<HeldOut> look(NodeTrainer& trainer) const;
  // The greatest τ, of a few a factor apart, at which a cut's pictures have in the mean half a dB
  // less than every leaf's at most: those of the nearer half of the views, and of the farther half.
  double best_tau(NodeTrainer& trainer) const;
  // Pictures that look() draws, and best_tau() at most.
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
