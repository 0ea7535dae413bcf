#include "runtime/frame/time_budget.h"

#include <algorithm>
#include <cmath>

namespace voyager {
namespace {

// Errors are log(time / aim), slopes what an error loses by one more of u.
constexpr double kAim = 0.9;  // of the budget: what is left is for frames unlike the last
// Of noise, the median difference of two frames at one τ: the dead band, which is also bounded.
constexpr double kBandOfNoise = 2, kLeastBand = 0.035, kLargestBand = 0.1;
// Of the dead band:
constexpr double kPatience = 2.2;  // what errors beyond it add up to before τ moves
constexpr double kClip = 3;        // of an error at rest: one frame alone never moves τ
static_assert(kClip - 1 < kPatience);
constexpr double kLate = 0.75;    // that a frame over the budget counts at least
constexpr double kNewLoad = 1.7;  // errors of that size are a new load; smaller ones drift
constexpr double kNear = 1;       // an error this small needs no further correction
constexpr double kFirstNoise = 0.04, kNoiseStep = 1.05;
constexpr double kShare = 0.7;       // of the way to the target, a frame
constexpr double kFastest = 0.5;     // of u, a frame
constexpr double kSnap = 0.02;       // of error, that is gone at once in any case
constexpr double kFirstSlope = 0.7;  // about the geometric mean of the next two
constexpr double kFlattest = 0.2, kSteepest = 2.0;
constexpr double kSlopeDoubt = 0.05;      // the step of u, squared, that is believed by half
constexpr double kLargestSurprise = 0.3;  // of which a slope is learned
constexpr size_t kMedian = 3;
constexpr size_t kFirstFrames = 2;

double u_of(double tau) {
  return std::log(tau + 0.5);
}

}  // namespace

TimeBudget::TimeBudget(const TimeBudgetDesc& desc, double tau)
    : tau_(std::clamp(tau, desc.least_tau, desc.greatest_tau)),
      u_(u_of(tau_)),
      target_(u_),
      slope_(kFirstSlope),
      noise_(kFirstNoise) {
  set(desc);
}

void TimeBudget::set(const TimeBudgetDesc& desc) {
  desc_ = desc;
  log_aim_ = std::log(kAim * desc.milliseconds);
  least_ = u_of(desc.least_tau), greatest_ = u_of(desc.greatest_tau);
  aim_at(target_);
}

void TimeBudget::aim_at(double u) {
  target_ = std::clamp(u, least_, greatest_);
}

void TimeBudget::measure(double tau, double milliseconds) {
  if (!(milliseconds > 0) || !std::isfinite(milliseconds)) return;
  if (skipped_ < kFirstFrames) {
    ++skipped_;
    return;
  }
  samples_[taken_++ % kSamples] = {tau, u_of(tau), std::log(milliseconds)};
  fresh_ = tau == tau_ ? fresh_ + 1 : 0;
  learn_slope();
  if (tracking_) {
    track();
  } else if (fresh_ > 0) {
    watch();
  }
  learn_noise();
}

double TimeBudget::band() const {
  return std::clamp(kBandOfNoise * noise_, kLeastBand, kLargestBand);
}

// By how much the newest frame's time differs from what the slope foretold, from the frame
// before it. Where both were drawn at one τ nothing is learned, whatever the load did.
void TimeBudget::learn_slope() {
  if (taken_ < 2) return;
  const double step = sample(0).u - sample(1).u;
  const double surprise = std::clamp(change() + slope_ * step, -kLargestSurprise, kLargestSurprise);
  slope_ -= surprise * step / (kSlopeDoubt + step * step);
  slope_ = std::clamp(slope_, kFlattest, kSteepest);
}

// Towards the median, which a few large changes do not move far.
void TimeBudget::learn_noise() {
  if (taken_ < 2 || sample(0).tau != sample(1).tau) return;
  noise_ *= std::fabs(change()) > noise_ ? kNoiseStep : 1 / kNoiseStep;
  noise_ = std::clamp(noise_, kLeastBand / kBandOfNoise, kLargestBand / kBandOfNoise);
}

double TimeBudget::clipped_error(size_t back) const {
  return std::clamp(error(back), -kClip * band(), kClip * band());
}

double TimeBudget::mean_error(size_t count) const {
  double sum = 0;
  for (size_t i = 0; i < count; ++i) sum += clipped_error(i);
  return sum / static_cast<double>(count);
}

// At rest: a cumulative sum on each side tells a shift from noise.
void TimeBudget::watch() {
  const double now = clipped_error(0) / band();
  const bool late = error(0) > -std::log(kAim);
  above_ = std::max(0.0, above_ + (late ? std::max(now - 1, kLate) : now - 1));
  below_ = std::max(0.0, below_ - now - 1);
  outside_ = above_ > 0 || below_ > 0 ? outside_ + 1 : 0;
  if (std::max(above_, below_) > kPatience) start(above_ > below_);
}

// One correction, by the mean of all frames at this τ, where the errors are small; where they
// are large τ follows from here on, to begin with by the smaller of the last two.
void TimeBudget::start(bool slower) {
  const double side = slower ? 1 : -1;
  double size = std::max(0.0, side * mean_error(std::min(fresh_, kSamples)));
  if (side * mean_error(std::min({outside_, fresh_, kSamples})) >= kNewLoad * band()) {
    tracking_ = true;
    size = std::max(size, std::min(side * error(0), side * error(1)));
  }
  above_ = below_ = 0;
  outside_ = 0;
  aim_at(u_ + side * size / slope_);
}

// Each of the last frames says where the aim is; their median is followed until it is here.
void TimeBudget::track() {
  std::array<double, kMedian> places;
  for (size_t i = 0; i < kMedian; ++i) places[i] = sample(i).u + error(i) / slope_;
  std::sort(places.begin(), places.end());
  const double place = places[kMedian / 2];
  aim_at(place);
  if (std::fabs(target_ - u_) * slope_ >= kNear * band()) return;
  if (target_ == place) target_ = u_;  // else it is the end of the range, which is gone to
  if (fresh_ >= kMedian) tracking_ = false;
}

double TimeBudget::next_tau() {
  if (target_ == u_) return tau_;
  const double way = std::fabs(target_ - u_);
  const double step = std::min(std::max(kShare * way, kSnap / slope_), kFastest);
  u_ = step >= way ? target_ : u_ + std::copysign(step, target_ - u_);
  tau_ = std::clamp(std::exp(u_) - 0.5, desc_.least_tau, desc_.greatest_tau);
  fresh_ = 0;
  return tau_;
}

}  // namespace voyager
