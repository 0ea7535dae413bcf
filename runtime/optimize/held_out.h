#pragma once
// How near cuts are to the truth in views that nothing was learned from.
#include <vector>

#include "runtime/optimize/optimize.h"
#include "runtime/optimize/training_views.h"

namespace voyager {

class HeldOutViews {
 public:
  HeldOutViews(const TrainingViews& views, uint32_t count, double leaves)
      : views_(views), count_(count), leaves_(leaves) {}

  // At the default τ, twice and five times it.
  std::vector<HeldOut> look(NodeTrainer& trainer) const;
  // The greatest τ, of a few a factor apart, at which a cut's pictures have in the mean half a dB
  // less than every leaf's at most: those of the nearer half of the views, and of the farther half.
  double best_tau(NodeTrainer& trainer) const;

 private:
  TrainingView view(uint32_t i, double tau) const;
  double psnr_of(const TrainingView& view, const TrainingError& error) const;

  const TrainingViews& views_;
  uint32_t count_;
  double leaves_;
};

}  // namespace voyager
