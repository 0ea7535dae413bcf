#pragma once
// τ from the times of frames: a pure controller, in u = log(τ + ½). Near any τ a frame takes
// about exp(load − slope·u), so a frame that was drawn at u and took t tells where the aim is:
// at u + log(t / aim) / slope, whenever it becomes known and wherever τ is by then. That is why
// frames in flight cause no ringing. docs/time-budget.md derives the rest and has its figures.
#include <array>
#include <cstddef>

namespace voyager {

// milliseconds > 0; 0 <= least_tau <= greatest_tau; all finite.
struct TimeBudgetDesc {
  double milliseconds = 0;
  double least_tau = 1, greatest_tau = 60;  // pixels
};

// No clock, no randomness: the same calls give the same τ, to the bit. τ rests, exactly, until
// times leave a dead band around the aim for longer than noise does; then it follows them until
// they are at the aim again.
class TimeBudget {
 public:
  // Starts at tau, or at the end of the range next to it.
  TimeBudget(const TimeBudgetDesc& desc, double tau);
  // Goes on from where τ is. Setting what is set already changes nothing.
  void set(const TimeBudgetDesc& desc);
  const TimeBudgetDesc& desc() const { return desc_; }

  // A frame that was drawn at tau took so long; in the frames' order, each once. A time that
  // is not a positive number is ignored, and so are the first two (uploads, a whole search).
  void measure(double tau, double milliseconds);
  // Of the next frame; to be called once a frame.
  double next_tau();

 private:
  struct Sample {
    double tau, u, log_time;
  };
  static constexpr size_t kSamples = 32;

  const Sample& sample(size_t back) const { return samples_[(taken_ - 1 - back) % kSamples]; }
  double error(size_t back) const { return sample(back).log_time - log_aim_; }
  double mean_error(size_t count) const;
  double clipped_error(size_t back) const;
  double band() const;
  double change() const { return sample(0).log_time - sample(1).log_time; }
  void learn_slope();
  void learn_noise();
  void watch();
  void start(bool slower);
  void track();
  void aim_at(double u);

  TimeBudgetDesc desc_;
  double log_aim_ = 0, least_ = 0, greatest_ = 0;  // the last two: u
  double tau_, u_, target_;
  double slope_, noise_;
  std::array<Sample, kSamples> samples_{};
  size_t taken_ = 0;    // ever
  size_t skipped_ = 0;  // before them
  size_t fresh_ = 0;    // the newest, all drawn at tau_
  bool tracking_ = false;
  // At rest: by how many dead bands, and for how many frames, errors have been beyond it.
  double above_ = 0, below_ = 0;
  size_t outside_ = 0;
};

}  // namespace voyager
