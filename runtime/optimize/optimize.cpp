#include "runtime/optimize/optimize.h"

#include <algorithm>

#include "runtime/base/error.h"
#include "runtime/lod/align.h"
#include "runtime/optimize/learn_scene.h"
#include "runtime/optimize/part.h"
#include "runtime/refine/extents.h"
#include "runtime/stages/learn.h"

namespace voyager {
namespace {

// Of a device's memory: the rest is for pictures and lists.
constexpr double kShareOfDevice = 0.7;
// Leaves around a part, for each of its own; and how many more pictures a part's nodes need, as
// those around do not learn from them.
constexpr double kAround = 1, kMorePictures = 2;
constexpr uint64_t kFewestLeaves = 256;
constexpr uint64_t kMostParts = 256;  // each is learned with what is around it

// Of the device's memory, by the trainer's arrays: a Gaussian and what finds it for each of about
// one and a half nodes a leaf, and two moments for each number of half a merged node.
double device_bytes_of_leaf(int sh_degree) {
  const int numbers = numbers_of(sh_degree);
  return 1.5 * (120 + 4.0 * numbers) + 0.5 * 8 * numbers;
}

// Leaves that learn at once.
uint64_t most_at_once(const BakedScene& baked, const OptimizeGoal& goal, const Backend& backend) {
  const int degree = baked.leaves.sh_degree;
  double room = static_cast<double>(baked.leaves.size());
  const auto fit = [&](double bytes, double of_leaf) {
    if (bytes >= of_leaf * static_cast<double>(baked.leaves.size())) return;
    room = std::min(room, bytes / (of_leaf * (1 + kAround)));
  };
  if (backend.memory_bytes() != 0)
    fit(kShareOfDevice * static_cast<double>(backend.memory_bytes()), device_bytes_of_leaf(degree));
  if (goal.memory != 0)
    fit(static_cast<double>(goal.memory), static_cast<double>(bytes_to_optimize(1, degree)));
  const auto most = static_cast<uint64_t>(room);
  const uint64_t least = std::max(baked.leaves.size() / kMostParts,
                                  std::min<uint64_t>(baked.leaves.size(), kFewestLeaves));
  if (most < least)
    throw Error(ErrorCode::over_budget, "memory: found room for " + std::to_string(most) +
                                            " Gaussians that learn at once, expected room for " +
                                            std::to_string(least) + " at least");
  return most;
}

void add_means(std::vector<HeldOut>& sums, const std::vector<HeldOut>& of, double share) {
  sums.resize(of.size());
  for (size_t i = 0; i < of.size(); ++i) {
    sums[i].tau = of[i].tau;
    sums[i].cut += share * of[i].cut;
    sums[i].leaves += share * of[i].leaves;
    sums[i].share += share * of[i].share;
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
    // What has learned in a part is not changed by the top, in which it learns once more.
    std::vector<bool> done(baked_.tree.size(), false);
    for (const PartRoots& roots : parts) {
      learn(take_part(baked_, roots, most_around), done,
            static_cast<double>(roots.leaves) / static_cast<double>(own));
      std::fill_n(done.begin() + roots.first, roots.count, true);
    }
    for (uint32_t n = 1; n < done.size(); ++n) done[n] = done[n] || done[baked_.tree.parent[n]];
    learn(take_top(baked_, most_leaves_), done, 0);
    never_grow_downwards(baked_.tree);
    baked_.learned = true;
    // Parents come before their children.
    for (uint32_t n = 0; n < baked_.tree.size(); ++n) align_children(n, baked_);
    return std::move(summary_);
  }

 private:
  // weight: of its held-out views in the summary.
  void learn(ScenePart part, const std::vector<bool>& done, double weight) {
    if (part.scene.merged.size() == 0) return;
    OptimizeGoal goal = goal_;
    const double share = kMorePictures * kMorePictures *
                         static_cast<double>(part.scene.merged.size()) /
                         static_cast<double>(baked_.merged.size());
    goal.pictures =
        goal.pictures == 0 ? 0 : std::max(1u, static_cast<uint32_t>(goal.pictures * share));
    goal.minutes *= share;
    const std::string kept = kept_ + "." + std::to_string(summary_.kept.size());
    const OptimizeSummary found =
        learn_scene(part.scene, {part.own_leaves, part.leaf_size, part.largest}, goal, backend_,
                    kept, workers_, progress_);
    give_back(part, done, baked_);
    summary_.kept.push_back(kept);
    summary_.pictures += found.pictures;
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
  OptimizeSummary summary_;
};

}  // namespace

uint32_t pictures_of(OptimizeQuality quality, uint64_t merged_nodes) {
  // For a thousand merged nodes, and at least.
  const auto number = [&](uint64_t of_thousand, uint64_t least) {
    return static_cast<uint32_t>(
        std::clamp<uint64_t>(merged_nodes * of_thousand / 1000, least, 1'000'000'000));
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
  const uint64_t most = most_at_once(baked, goal, backend);
  if (most < baked.leaves.size())
    return InParts(baked, goal, most, backend, kept, workers, progress).run();
  OptimizeSummary summary =
      learn_scene(baked, {baked.leaves.size(), 0, 0}, goal, backend, kept, workers, progress);
  summary.kept = {kept};
  return summary;
}

// Rows of 3 × numbers, for each of about half as many merged nodes, in the trainer's state, in what
// is kept and in its file's bytes; and the scene as backends draw it.
uint64_t bytes_to_optimize(uint64_t gaussians, int sh_degree) {
  const auto numbers = static_cast<uint64_t>(numbers_of(sh_degree));
  return gaussians * (3 * 3 * numbers * sizeof(float) / 2 + 3 * numbers * sizeof(float));
}

uint64_t least_bytes_to_optimize(uint64_t gaussians, int sh_degree) {
  return bytes_to_optimize(std::max(gaussians / kMostParts, std::min(gaussians, kFewestLeaves)),
                           sh_degree);
}

}  // namespace voyager
