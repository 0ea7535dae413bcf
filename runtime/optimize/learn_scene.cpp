#include "runtime/optimize/learn_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/first_that.h"
#include "runtime/frame/built_scene.h"
#include "runtime/lod/align.h"
#include "runtime/lod/stand_in.h"
#include "runtime/optimize/checkpoint.h"
#include "runtime/optimize/held_out.h"
#include "runtime/refine/extents.h"

namespace voyager {
namespace {

// Chosen on one district (bench/NOTES.md).
constexpr LearningRates kRates{0.02f, 0.01f, 0.002f, 0.03f, 0.006f, 0.0006f, 1};
constexpr double kLastPace = 0.05;  // at the end

// Extents are measured anew when these shares of the steps are done: what learned has another
// error, and other cuts learn from then on.
constexpr double kMeasureAt[] = {0.4, 0.7, 1.0};
// Of the cuts that are measured, as refine.cpp's.
constexpr double kMeasureTaus[] = {2, 8, 30};
// Views that are measured: one for ten pictures that are learned from until there are 64, so that
// each node is seen in some; then no more until they are one for sixty.
constexpr uint32_t kPicturesAtFirst = 10, kMeasuresAtFirst = 64, kPicturesLater = 60;
constexpr uint32_t kLeastMeasures = 8, kMostMeasures = 256;
constexpr uint32_t measures_of(uint32_t pictures) {
  const uint32_t first = std::min(pictures / kPicturesAtFirst, kMeasuresAtFirst);
  return std::clamp(std::max(first, pictures / kPicturesLater), kLeastMeasures, kMostMeasures);
}
// Of views that extents are measured in, that choose their scale, and that say what was gained.
// Their last digits differ in the bases of Halton's sequence. A large power of a base would differ
// from 0 in a far digit only, and its views would look at the leaves of those that are learned
// from.
constexpr uint32_t kFirstMeasure = 134'217'757, kFirstChosenBy = 201'326'611,
                   kFirstHeldOut = 268'435'459;

constexpr uint32_t kTimedSteps = 48, kWarmSteps = 16;
// What is gained so far is told when this share is done, and where extents are measured.
constexpr double kFirstTold = 0.1;
constexpr auto kTimesTold = static_cast<uint32_t>(1 + std::size(kMeasureAt));
// In so many views, at which of HeldOutViews' τ.
constexpr uint32_t kFew = 6;
constexpr size_t kToldTau = 1;

LearningRates rates_at(double done) {
  LearningRates rates = kRates;
  rates.pace = static_cast<float>(std::pow(kLastPace, done));
  return rates;
}

class Learning {
 public:
  Learning(BakedScene& baked, const LookedAt& looked_at, const OptimizeGoal& goal, Backend& backend,
           const std::string& kept, Workers& workers, const Progress& progress)
      : baked_(baked),
        kept_(kept),
        progress_(progress),
        mark_(mark_of(baked, goal.cameras, backend.device_name())),
        views_(baked, looked_at, goal.cameras),
        held_out_(views_, kFirstHeldOut, goal.held_out, looked_at.leaves, baked.leaves.size()),
        few_(views_, kFirstHeldOut, std::min(goal.held_out, kFew), looked_at.leaves,
             baked.leaves.size()),
        chosen_by_(views_, kFirstChosenBy, goal.held_out, looked_at.leaves, baked.leaves.size()),
        trainer_(backend.create_trainer(scene_of(baked, workers), workers)) {}

  OptimizeSummary run(const OptimizeGoal& goal, ShrinkExtents shrink) {
    OptimizeSummary summary;
    const bool goes_on = read_kept(goal);
    summary.before = held_out_.look(*trainer_);
    goes_on ? go_on() : begin(goal);
    learn(goal.keep_milliseconds, summary.before);
    summary.pictures = checkpoint_.pictures;
    summary.shrink = extent_scale();
    if (shrink == ShrinkExtents::yes) {
      shrink_extents(summary.shrink, baked_.tree);
      give_extents();
      trainer_->set_extents(checkpoint_.extents);
    }
    summary.after = held_out_.look(*trainer_);
    take_learned();
    return summary;
  }

 private:
  // False where nothing was kept. Refuses before anything is drawn.
  bool read_kept(const OptimizeGoal& goal) {
    if (!read_checkpoint(mark_, kept_, checkpoint_)) return false;
    if (checkpoint_.asked == goal.asked) return true;
    throw Error(ErrorCode::refused_input, kept_ + ": found what is learned " + checkpoint_.asked +
                                              ", expected " + goal.asked +
                                              ": ask for the same, or remove it");
  }

  void go_on() {
    trainer_->set_state(checkpoint_.state);
    take_extents();
  }

  void begin(const OptimizeGoal& goal) {
    checkpoint_.asked = goal.asked;
    checkpoint_.pictures = goal.pictures != 0 ? goal.pictures : steps_in(goal.minutes);
    checkpoint_.extents.resize(baked_.tree.size());
    give_extents();
  }

  uint32_t steps_in(double minutes) {
    const TrainingState untouched = trainer_->state();
    for (uint32_t k = 0; k < kWarmSteps; ++k) trainer_->step(views_.picture(k), {});
    const Stopwatch watch;
    for (uint32_t k = 0; k < kTimedSteps; ++k) trainer_->step(views_.picture(kWarmSteps + k), {});
    const double each = std::max(watch.milliseconds() / kTimedSteps, 1e-3);
    trainer_->set_state(untouched);
    return pictures_in(minutes, each,
                       kWarmSteps + kTimedSteps + 2 * held_out_.pictures_of_look() +
                           kTimesTold * few_.pictures_of_look() +
                           chosen_by_.pictures_of_best_tau());
  }

  void learn(double keep_milliseconds, const std::vector<HeldOut>& before) {
    Stopwatch since_kept;
    const uint32_t steps = checkpoint_.pictures;
    std::string stage = "optimizing";
    while (checkpoint_.done < steps) {
      const uint32_t k = checkpoint_.done++;
      report(progress_, stage.c_str(), k, steps);
      trainer_->step(views_.picture(k), rates_at(static_cast<double>(k) / steps));
      const auto is_done = [&](double share) {
        return checkpoint_.done == static_cast<uint32_t>(std::ceil(share * steps));
      };
      bool tells = is_done(kFirstTold);
      for (const double share : kMeasureAt)
        if (is_done(share)) {
          measure();
          tells = true;
        }
      if (tells) stage = "optimizing (" + gained_so_far(before) + ")";
      if (since_kept.milliseconds() < keep_milliseconds && checkpoint_.done < steps) continue;
      checkpoint_.state = trainer_->state();
      give_extents();
      write_checkpoint(checkpoint_, mark_, kept_);
      since_kept = {};
    }
    report(progress_, "optimizing", steps, steps);
  }

  // In a few of the held-out views.
  std::string gained_so_far(const std::vector<HeldOut>& before) const {
    const HeldOut now = few_.look(*trainer_)[kToldTau];
    double gained = 0;
    for (size_t view = 0; view < now.views.size(); ++view)
      gained += now.views[view].cut - psnr_with_share(before, view, now.views[view].share);
    char text[64];
    std::snprintf(text, sizeof text, "%+.1f dB at tau %g",
                  gained / static_cast<double>(std::max<size_t>(now.views.size(), 1)), now.tau);
    return text;
  }

  void measure() {
    Measured measured(baked_.tree.size());
    const uint32_t views = measures_of(checkpoint_.pictures);
    for (uint32_t i = 0; i < views; ++i)
      for (const double tau : kMeasureTaus) {
        TrainingView view = views_(kFirstMeasure + i);
        view.tau = tau;
        const Vec3d& eye = view.camera.eye;
        const Vec3f centre =
            cut_centre(eye, {baked_.origin[0], baked_.origin[1], baked_.origin[2]});
        for (const NodeError& found : trainer_->node_errors(view)) {
          const NodeRecord& r = baked_.tree.records[found.node];
          const double metres = double{squared_distance(centre, r.box_min, r.box_max)} /
                                (view.camera.fx * view.camera.fx);
          measured.gain[found.node] += double{found.squares} * metres / (r.child_count - 1);
          ++measured.pictures[found.node];
        }
      }
    set_extents(measured, baked_.tree);
    give_extents();
    trainer_->set_extents(checkpoint_.extents);
  }

  // By which extents are to be multiplied, so that the default τ draws no more than it has to. At
  // most 1.
  double extent_scale() const {
    const double tau = chosen_by_.best_tau(*trainer_);
    return std::min((2 * kReferenceTau + 1) / (2 * tau + 1), 1.0);
  }

  void give_extents() {
    for (size_t n = 0; n < baked_.tree.size(); ++n)
      checkpoint_.extents[n] = baked_.tree.records[n].extent;
  }
  void take_extents() {
    for (size_t n = 0; n < baked_.tree.size(); ++n)
      baked_.tree.records[n].extent = checkpoint_.extents[n];
    trainer_->set_extents(checkpoint_.extents);
  }

  void take_learned() {
    const TrainingState state = trainer_->state();
    const auto numbers = static_cast<size_t>(numbers_of(baked_.leaves.sh_degree));
    const size_t coefficients = numbers - kShapeNumbers;
    GaussianCloud& merged = baked_.merged;
    size_t row = 0;
    for (uint32_t n = 0; n < baked_.tree.size(); ++n) {
      if (baked_.tree.is_leaf(n)) continue;
      const float* v = &state.values[row * numbers];
      const size_t i = baked_.gaussian[n];
      std::copy_n(v, 3, &merged.position[3 * i]);
      for (size_t axis = 0; axis < 3; ++axis)
        merged.log_scale[3 * i + axis] = std::log(v[3 + axis]);
      std::copy_n(v + 6, 4, &merged.rotation[4 * i]);
      merged.opacity[i] = state.opacities[row++];
      std::copy_n(v + kShapeNumbers, coefficients, &merged.sh[i * coefficients]);
    }
    baked_.learned = true;
    // Parents come before their children.
    for (uint32_t n = 0; n < baked_.tree.size(); ++n) align_children(n, baked_);
  }

  BakedScene& baked_;
  const std::string& kept_;
  const Progress& progress_;
  const uint64_t mark_;
  const TrainingViews views_;
  const HeldOutViews held_out_, few_, chosen_by_;
  std::unique_ptr<NodeTrainer> trainer_;
  Checkpoint checkpoint_;
};

}  // namespace

uint32_t measured_with(uint32_t pictures) {
  return static_cast<uint32_t>(std::size(kMeasureAt) * std::size(kMeasureTaus)) *
         measures_of(pictures);
}

uint32_t pictures_in(double minutes, double milliseconds, uint32_t others) {
  const double most = minutes * 60000 / milliseconds - others;
  const uint32_t too_many = first_that(1u, kMostPictures + 1, [&](uint32_t pictures) {
    return static_cast<double>(pictures) + measured_with(pictures) > most;
  });
  return std::max(too_many - 1, 1u);
}

void shrink_extents(double by, LodTree& tree) {
  for (NodeRecord& r : tree.records) {
    const auto changed = static_cast<float>(by * double{r.extent});
    if (std::isfinite(changed)) r.extent = changed;
  }
}

OptimizeSummary learn_scene(BakedScene& baked, const LookedAt& looked_at, const OptimizeGoal& goal,
                            ShrinkExtents shrink, Backend& backend, const std::string& kept,
                            Workers& workers, const Progress& progress) {
  return Learning(baked, looked_at, goal, backend, kept, workers, progress).run(goal, shrink);
}

}  // namespace voyager
