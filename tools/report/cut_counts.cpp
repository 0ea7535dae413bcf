#include "tools/report/cut_counts.h"

#include <cmath>
#include <numeric>

#include "runtime/base/workers.h"

namespace voyager::tools {
namespace {

constexpr size_t kBlock = 1 << 16;  // nodes
// Of tau, in pixels: below the least it makes no difference that a bisection could go after, and
// at the most all that does not surround the camera has merged.
constexpr double kLeast = 0x1p-10, kMost = 0x1p20;
constexpr double kNear = 1e-4;
// Halvings of log tau, after which binary32 has no sizes between the two ends.
constexpr int kSteps = 40;

uint64_t distance(uint64_t a, uint64_t b) {
  return a < b ? b - a : a - b;
}

}  // namespace

CutCounts::CutCounts(const LodTree& tree, Workers& workers) : tree_(tree), workers_(workers) {
  for (uint32_t n = 0; n < tree.size(); ++n)
    if (!tree.is_leaf(n)) {
      interior_.push_back(n);
      added_.push_back(tree.records[n].child_count - 1);
    }
  sizes_.resize(interior_.size());
}

void CutCounts::look_from(const Vec3f& centre) {
  workers_.for_blocks(sizes_.size(), kBlock, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) sizes_[i] = tree_.screen_size(interior_[i], centre);
  });
}

// Sizes never grow from parent to child, so that whatever is refined is below refined nodes alone:
// each puts its children in its place.
uint64_t CutCounts::at(float target_size) const {
  std::vector<uint64_t> added((sizes_.size() + kBlock - 1) / kBlock);
  workers_.for_blocks(sizes_.size(), kBlock, [&](size_t begin, size_t end) {
    uint64_t sum = 0;
    for (size_t i = begin; i < end; ++i) sum += sizes_[i] >= target_size ? added_[i] : 0;
    added[begin / kBlock] = sum;
  });
  return std::accumulate(added.begin(), added.end(), uint64_t{1});
}

TauOfCut tau_of_cut(uint64_t wanted, const std::function<uint64_t(double)>& cut_at) {
  const auto found = [&](double tau) { return TauOfCut{tau, cut_at(tau)}; };
  if (const TauOfCut zero = found(0); zero.cut <= wanted) return zero;
  TauOfCut low = found(kLeast), high = found(kMost);
  if (low.cut <= wanted) return low;
  if (high.cut >= wanted) return high;
  const auto nearer = [&] {
    return distance(low.cut, wanted) < distance(high.cut, wanted) ? low : high;
  };
  const double near = kNear * static_cast<double>(wanted);
  for (int step = 0; step < kSteps; ++step) {
    if (static_cast<double>(distance(nearer().cut, wanted)) <= near) break;
    const TauOfCut middle = found(std::sqrt(low.tau * high.tau));
    (middle.cut > wanted ? low : high) = middle;
  }
  return nearer();
}

}  // namespace voyager::tools
