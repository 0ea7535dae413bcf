#include "runtime/select/detail.h"

#include <algorithm>
#include <bit>

#include "runtime/lod/round_bounds.h"

namespace voyager {
namespace {

constexpr uint32_t kMantissa = 0x007fffffu;
// Of a node that is always refined; finite, so that no search meets ∞ · 0.
constexpr float kAlwaysRefined = 1e30f;

// The power of two from extent on; exact. What has no exponent is raised to the least that has.
float round_up(float extent) {
  const uint32_t bits = std::bit_cast<uint32_t>(extent);
  if ((bits & kMantissa) == 0 || !(extent <= 0x1p127f)) return extent;
  return std::bit_cast<float>((bits & ~kMantissa) + kMantissa + 1);
}

void set_levels(LodTree& tree) {
  for (NodeRecord& r : tree.records) r.extent = r.child_count == 0 ? 0.0f : round_up(r.extent);
}

class Blocks {
 public:
  Blocks(LodTree& tree, const Partition& partition) : tree_(tree), begin_(partition.level_begin) {
    const auto nodes_on = [&](size_t level) { return begin_[level + 1] - begin_[level]; };
    while (first_ + 2 < begin_.size() && nodes_on(first_) < kBlocks) ++first_;
  }

  void set() {
    for (uint32_t n = 0; n < begin_[first_]; ++n) {
      NodeRecord& r = tree_.records[n];
      r.extent = r.child_count == 0 ? 0.0f : kAlwaysRefined;
    }
    find_blocks();
    // From the deepest level up, so that sizes never grow downwards.
    std::vector<float> extent(begin_[first_ + 1] - begin_[first_], 0.0f);
    for (size_t level = begin_.size() - 1; level-- > first_;) {
      raise_to_means(level, extent);
      set_level(level, extent);
    }
  }

 private:
  void find_blocks() {
    block_.resize(tree_.size());
    for (uint32_t n = begin_[first_]; n < tree_.size(); ++n)
      block_[n] = n < begin_[first_ + 1] ? n - begin_[first_] : block_[tree_.parent[n]];
  }

  void raise_to_means(size_t level, std::vector<float>& extent) const {
    std::vector<double> sum(extent.size()), count(extent.size());
    for (uint32_t n = begin_[level]; n < begin_[level + 1]; ++n) {
      const NodeRecord& r = tree_.records[n];
      if (r.child_count == 0) continue;
      sum[block_[n]] += r.extent;
      ++count[block_[n]];
    }
    for (size_t b = 0; b < extent.size(); ++b)
      if (count[b] > 0) extent[b] = std::max(extent[b], static_cast<float>(sum[b] / count[b]));
  }

  void set_level(size_t level, const std::vector<float>& extent) {
    for (uint32_t n = begin_[level]; n < begin_[level + 1]; ++n) {
      NodeRecord& r = tree_.records[n];
      const NodeRecord& root = tree_.records[begin_[first_] + block_[n]];
      r.box_min = root.box_min;
      r.box_max = root.box_max;
      r.extent = r.child_count == 0 ? 0.0f : extent[block_[n]];
    }
  }

  LodTree& tree_;
  const std::pmr::vector<uint32_t>& begin_;  // of levels, and the end
  size_t first_ = 0;                         // the level of the blocks' roots
  std::vector<uint32_t> block_;              // by node, from that level on
};

}  // namespace

DetailTree make_detail_tree(const LodTree& tree, const Partition& partition, Lod lod,
                            Workers& workers, std::pmr::memory_resource* memory) {
  DetailTree detail{LodTree(memory), SearchTree(memory)};
  detail.tree = tree;
  if (tree.size() == 0) return detail;
  if (lod == Lod::blocks)
    Blocks(detail.tree, partition).set();
  else
    set_levels(detail.tree);
  round_bounds(detail.tree, workers);
  detail.search = make_search_tree(detail.tree, partition, {}, workers, memory);
  return detail;
}

}  // namespace voyager
