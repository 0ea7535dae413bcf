#include "cuda/scene/sweep_tree.h"

#include <bit>
#include <vector>

namespace voyager::cuda {

SweepTree::SweepTree(const LodTree& tree)
    : nodes_(static_cast<uint32_t>(tree.size())), blend_share_(tree.blend_share) {
  std::vector<float4> low;
  std::vector<Vec3f> high;
  std::vector<SweepWord> words((tree.size() + 31) / 32, SweepWord{});
  for (uint32_t n = 0; n < nodes_; ++n) {
    const NodeRecord& r = tree.records[n];
    const uint32_t bit = 1u << n % 32;
    if (n != 0 && tree.first_child[tree.parent[n]] == n) words[n / 32].first_children |= bit;
    if (tree.is_leaf(n)) continue;
    words[n / 32].interior |= bit;
    low.push_back({r.box_min.x, r.box_min.y, r.box_min.z, r.extent});
    high.push_back(r.box_max);
  }
  for (size_t w = 1; w < words.size(); ++w) {
    const SweepWord& before = words[w - 1];
    words[w].interior_before =
        before.interior_before + static_cast<uint32_t>(std::popcount(before.interior));
    words[w].families_before =
        before.families_before + static_cast<uint32_t>(std::popcount(before.first_children));
  }
  allocate_together(ToAllocate{low_, low.size()}, ToAllocate{high_, high.size()},
                    ToAllocate{words_, words.size()});
  upload<float4>(low, low_);
  upload<Vec3f>(high, high_);
  upload<SweepWord>(words, words_);
}

SweepView SweepTree::view() const {
  return {low_.data(), high_.data(), words_.data(), static_cast<uint32_t>(low_.size()),
          nodes_,      blend_share_};
}

}  // namespace voyager::cuda
