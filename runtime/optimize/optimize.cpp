#include "runtime/optimize/optimize.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "runtime/base/error.h"
#include "runtime/lod/align.h"
#include "runtime/optimize/checkpoint.h"
#include "runtime/optimize/held_out.h"
#include "runtime/optimize/learn_scene.h"
#include "runtime/optimize/part.h"
#include "runtime/refine/extents.h"
#include "runtime/stages/learn.h"

namespace voyager {
namespace {

// The rest of a device's memory is left to pictures and to lists of splats.
constexpr double kShareOfDevice = 0.7;
// Leaves that stand around a part, for each of its own.
constexpr double kAround = 1;
// How many times as many pictures a part's nodes get as all at once: what stands around them is in
// the same pictures, and learns nothing.
constexpr double kMorePictures = 4;
constexpr double kMinutesOfTop = 0.1;  // of all
constexpr uint32_t kFewestHeldOut = 6;
constexpr uint64_t kFewestLeaves = 256, kMostParts = 256;

// The arrays of the device's trainer: each of about 1.5 nodes a leaf is a Gaussian, with what finds
// it in a search; half a merged node a leaf has two moments for each of its numbers; and at most a
// node a leaf is in a cut, with its gradient and the sums that it is made from.
double device_bytes_of_leaf(int sh_degree) {
  const int numbers = numbers_of(sh_degree);
  return 1.5 * (120 + 4.0 * numbers) + 0.5 * 8 * numbers + (120 + 4.0 * numbers);
}

uint64_t fewest_at_once(uint64_t leaves) {
  return std::max(leaves / kMostParts, std::min(leaves, kFewestLeaves));
}

// Leaves that learn at once.
uint64_t most_at_once(const BakedScene& baked, const OptimizeGoal& goal, const Backend& backend) {
  const int degree = baked.leaves.sh_degree;
  double room = static_cast<double>(baked.leaves.size());
  const char* short_of = "memory";
  const auto fit = [&](double bytes, double of_leaf, const char* whose) {
    if (bytes >= of_leaf * static_cast<double>(baked.leaves.size())) return;
    const double fits = bytes / (of_leaf * (1 + kAround));
    if (fits >= room) return;
    room = fits;
    short_of = whose;
  };
  if (backend.memory_bytes() != 0)
    fit(kShareOfDevice * static_cast<double>(backend.memory_bytes()), device_bytes_of_leaf(degree),
        "device memory");
  if (goal.memory != 0)
    fit(static_cast<double>(goal.memory), static_cast<double>(bytes_to_optimize(1, degree)),
        "host memory");
  const auto most = static_cast<uint64_t>(room);
  const uint64_t least = fewest_at_once(baked.leaves.size());
  if (most < least)
    throw Error(ErrorCode::over_budget, short_of + std::string(": found room for ") +
                                            std::to_string(most) +
                                            " Gaussians that learn at once, expected room for " +
                                            std::to_string(least) + " at least");
  return most;
}

std::string asked_text(const OptimizeGoal& goal) {
  char text[48];
  if (goal.pictures != 0)
    std::snprintf(text, sizeof text, "from %u pictures", goal.pictures);
  else
    std::snprintf(text, sizeof text, "in %g minutes", goal.minutes);
  return text;
}

void add_means(std::vector<HeldOut>& sums, const std::vector<HeldOut>& of, double share) {
  sums.resize(of.size());
  for (size_t i = 0; i < of.size(); ++i) {
    sums[i].tau = of[i].tau;
    sums[i].cut += share * of[i].cut;
    sums[i].leaves += share * of[i].leaves;
    sums[i].share += share * of[i].share;
    sums[i].views.insert(sums[i].views.end(), of[i].views.begin(), of[i].views.end());
  }
}

// One part after another, then what is above them all.
class InParts {
 public:
  InParts(BakedScene& baked, const OptimizeGoal& goal, uint64_t most_leaves, Backend& backend,
          const std::string& kept, Workers& workers, const Progress& progress)
      : baked_(baked),
        goal_(goal),
        most_leaves_(most_leaves),
        backend_(backend),
        kept_(kept),
        workers_(workers),
        progress_(progress) {}

  OptimizeSummary run() {
    const std::vector<PartRoots> parts = part_roots(baked_.tree, most_leaves_);
    const auto most_around = static_cast<uint64_t>(kAround * static_cast<double>(most_leaves_));
    uint64_t own = 0;
    for (const PartRoots& roots : parts) own += roots.leaves;
    const auto held_out =
        std::max(kFewestHeldOut, static_cast<uint32_t>(2 * goal_.held_out / parts.size()));
    held_out_ = std::min(goal_.held_out, held_out);
    // What has learned in a part is not changed by the top, in which it learns once more.
    std::vector<bool> done(baked_.tree.size(), false);
    for (size_t k = 0; k < parts.size(); ++k) {
      stage_ = "part " + std::to_string(k + 1) + " of " + std::to_string(parts.size()) + ", ";
      const double share = static_cast<double>(parts[k].leaves) / static_cast<double>(own);
      learn(take_part(baked_, parts[k], most_around), done, kMorePictures,
            (1 - kMinutesOfTop) * share, share);
      std::fill_n(done.begin() + parts[k].first, parts[k].count, true);
    }
    mend_tree();
    for (uint32_t n = 1; n < done.size(); ++n) done[n] = done[n] || done[baked_.tree.parent[n]];
    stage_ = "above the parts, ";
    learn(take_top(baked_, most_leaves_), done, 1, kMinutesOfTop, 0);
    mend_tree();
    // One factor for all: detail would change where parts meet.
    summary_.shrink = std::exp(log_shrink_);
    shrink_extents(summary_.shrink, baked_.tree);
    for (HeldOut& after : summary_.after)
      after.tau = 0.5 * (summary_.shrink * (2 * after.tau + 1) - 1);
    return std::move(summary_);
  }

 private:
  // After some of its nodes have learned.
  void mend_tree() {
    never_grow_downwards(baked_.tree);
    baked_.learned = true;
    // Parents come before their children.
    for (uint32_t n = 0; n < baked_.tree.size(); ++n) align_children(n, baked_);
  }

  // pictures: times those of its share of the merged nodes; minutes: of all; weight: of its
  // held-out views in the summary.
  void learn(ScenePart part, const std::vector<bool>& done, double pictures, double minutes,
             double weight) {
    OptimizeGoal goal = goal_;
    goal.held_out = held_out_;
    goal.minutes *= minutes;
    const double share = pictures * static_cast<double>(part.scene.merged.size()) /
                         static_cast<double>(baked_.merged.size());
    if (goal.pictures != 0)
      goal.pictures = std::max(1u, static_cast<uint32_t>(goal.pictures * share));
    const Progress progress = [&](const char* stage, uint64_t at, uint64_t of) {
      report(progress_, (stage_ + stage).c_str(), at, of);
    };
    const OptimizeSummary found = learn_scene(
        part.scene, {part.own_leaves, part.leaf_size, part.largest}, goal, ShrinkExtents::no,
        backend_, kept_of_part(kept_, number_++), workers_, progress);
    give_back(part, done, baked_);
    summary_.pictures += found.pictures;
    if (weight == 0) return;
    log_shrink_ += weight * std::log(found.shrink);
    add_means(summary_.before, found.before, weight);
    add_means(summary_.after, found.after, weight);
  }

  BakedScene& baked_;
  const OptimizeGoal& goal_;
  const uint64_t most_leaves_;
  Backend& backend_;
  const std::string& kept_;
  Workers& workers_;
  const Progress& progress_;
  uint32_t held_out_ = 0, number_ = 0;
  double log_shrink_ = 0;
  std::string stage_;
  OptimizeSummary summary_;
};

}  // namespace

double OptimizeSummary::least_gain(size_t of) const {
  double least = std::numeric_limits<double>::infinity();
  for (size_t view = 0; view < after[of].views.size(); ++view) {
    const HeldOut::View& now = after[of].views[view];
    least = std::min(least, now.cut - psnr_with_share(before, view, now.share));
  }
  return least;
}

uint32_t pictures_of(OptimizeQuality quality, uint64_t merged_nodes) {
  // For a thousand merged nodes, and at least.
  const auto number = [&](uint64_t of_thousand, uint64_t least) {
    return static_cast<uint32_t>(
        std::clamp<uint64_t>(merged_nodes * of_thousand / 1000, least, kMostPictures));
  };
  switch (quality) {
    case OptimizeQuality::draft:
      return number(20, 600);
    case OptimizeQuality::best:
      return number(400, 10'000);
    default:
      return number(100, 2400);
  }
}

OptimizeSummary optimize_nodes(BakedScene& baked, const OptimizeGoal& goal, Backend& backend,
                               const std::string& kept, Workers& workers,
                               const Progress& progress) {
  if (baked.kind != TreeKind::clustered)
    throw Error(ErrorCode::unsupported,
                kept + ": found a tree of another kind, expected a clustered one");
  if (baked.tree.size() < 2) return {};
  OptimizeGoal whole = goal;
  whole.asked = asked_text(goal);
  const uint64_t most = most_at_once(baked, goal, backend);
  if (most < baked.leaves.size())
    return InParts(baked, whole, most, backend, kept, workers, progress).run();
  return learn_scene(baked, {baked.leaves.size(), 0, 0}, whole, ShrinkExtents::yes, backend, kept,
                     workers, progress);
}

// About half a merged node a leaf has its numbers and two moments of each, three times: in the
// trainer's state, in what is kept, and in the bytes of its file. Beside them is the scene as
// backends draw it.
uint64_t bytes_to_optimize(uint64_t gaussians, int sh_degree) {
  const auto numbers = static_cast<uint64_t>(numbers_of(sh_degree));
  return gaussians * (3 * 3 * numbers * sizeof(float) / 2 + 3 * numbers * sizeof(float));
}

uint64_t least_bytes_to_optimize(uint64_t gaussians, int sh_degree) {
  return static_cast<uint64_t>(1 + kAround) *
         bytes_to_optimize(fewest_at_once(gaussians) + 1, sh_degree);
}

}  // namespace voyager
