#include "runtime/optimize/held_out.h"

#include <algorithm>
#include <cmath>

#include "runtime/lod/stand_in.h"

namespace voyager {
namespace {

constexpr double kTaus[] = {kReferenceTau, 2 * kReferenceTau, 5 * kReferenceTau};
// Of 2τ + 1, that are tried: each so much more than the one before.
constexpr double kLeastSize = 1.5, kStep = 1.2599210498948732;  // ∛2
constexpr int kSteps = 16;
constexpr double kTolerated = 0.5;  // dB, below every leaf

}  // namespace

double psnr_with_share(std::span<const HeldOut> looked, size_t view, double share) {
  double finer_share = 1, finer = looked.front().views[view].leaves;
  for (const HeldOut& cut : looked) {
    const HeldOut::View& at = cut.views[view];
    if (!(at.share > 0)) return finer;  // a view of nothing that learns
    if (at.share <= share && at.share < finer_share) {
      const double t = std::log(share / at.share) / std::log(finer_share / at.share);
      return at.cut + std::min(t, 1.0) * (finer - at.cut);
    }
    finer_share = at.share;
    finer = at.cut;
  }
  return finer;
}

TrainingView HeldOutViews::view(uint32_t i, double tau) const {
  TrainingView view = views_(first_ + i);
  view.tau = tau;
  return view;
}

double HeldOutViews::psnr_of(const TrainingView& view, const TrainingError& error) const {
  const double mean = error.squares / (3.0 * view.camera.width * view.camera.height);
  return -10 * std::log10(std::max(mean, 1e-10));
}

std::vector<HeldOut> HeldOutViews::look(NodeTrainer& trainer) const {
  std::vector<HeldOut> all;
  for (const double tau : kTaus) all.push_back({tau, 0, 0, 0, {}});
  for (uint32_t i = 0; i < count_; ++i) {
    const TrainingView whole = view(i, 0);
    const double leaves = psnr_of(whole, trainer.error_of_leaves(whole));
    for (HeldOut& found : all) {
      const TrainingView at = view(i, found.tau);
      const TrainingError error = trainer.error(at);
      const HeldOut::View& looked = found.views.emplace_back(HeldOut::View{
          psnr_of(at, error), leaves,
          static_cast<double>(error.cut - around_) / static_cast<double>(looked_at_)});
      found.cut += looked.cut / count_;
      found.leaves += looked.leaves / count_;
      found.share += looked.share / count_;
    }
  }
  return all;
}

double HeldOutViews::best_tau(NodeTrainer& trainer) const {
  std::vector<std::pair<double, uint32_t>> by_distance;
  for (uint32_t i = 0; i < count_; ++i) by_distance.emplace_back(views_.distance(first_ + i), i);
  std::sort(by_distance.begin(), by_distance.end());
  std::vector<double> leaves(count_);
  for (uint32_t i = 0; i < count_; ++i) {
    const TrainingView whole = view(i, 0);
    leaves[i] = psnr_of(whole, trainer.error_of_leaves(whole));
  }
  const uint32_t near_views = count_ / 2;
  const double near_least = -kTolerated * near_views,
               far_least = -kTolerated * (count_ - near_views);
  double best = 0.5 * (kLeastSize - 1), size = kLeastSize;
  for (int step = 0; step < kSteps; ++step, size *= kStep) {
    const double tau = 0.5 * (size - 1);
    double gained[2] = {0, 0};  // near, far
    for (uint32_t i = 0; i < count_; ++i) {
      const uint32_t k = by_distance[i].second;
      const TrainingView at = view(k, tau);
      gained[i < near_views ? 0 : 1] += psnr_of(at, trainer.error(at)) - leaves[k];
    }
    if (gained[0] < near_least || gained[1] < far_least) break;
    best = tau;
  }
  return best;
}

uint32_t HeldOutViews::pictures_of_look() const {
  return count_ * (1 + static_cast<uint32_t>(std::size(kTaus)));
}
uint32_t HeldOutViews::pictures_of_best_tau() const {
  return count_ * (1 + kSteps);
}

}  // namespace voyager
