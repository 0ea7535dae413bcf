#include "runtime/bake/plan.h"

#include <algorithm>

#include "runtime/lod/shape.h"

namespace voyager {
namespace {

// Then no root has its descendants in several subtrees: a tier has a subtree a root.
static_assert(1 + kChildren + kChildren * kChildren <= kSubtreeNodes);

using Sizes = std::vector<uint32_t>;

// Of the level below.
Sizes children_of(const Sizes& sizes) {
  Sizes below;
  for (const uint32_t size : sizes) {
    if (size < 2) continue;
    const Parts parts = split_in_parts(size);
    below.insert(below.end(), parts.size, parts.size + parts.count);
  }
  return below;
}

// Nodes of each level of a tree, from how often each size occurs: few differ.
std::vector<uint64_t> count_levels(uint32_t gaussians) {
  std::vector<uint64_t> counts;
  std::map<uint32_t, uint64_t> level{{gaussians, 1}};
  while (!level.empty()) {
    uint64_t nodes = 0;
    std::map<uint32_t, uint64_t> below;
    for (const auto& [size, count] : level) {
      nodes += count;
      if (size < 2) continue;
      const Parts parts = split_in_parts(size);
      for (uint32_t i = 0; i < parts.count; ++i) below[parts.size[i]] += count;
    }
    counts.push_back(nodes);
    level = std::move(below);
  }
  return counts;
}

// The first tier that leaves the fewest subtrees; of several, that of most levels
// (runtime/lod/subtrees.cpp chooses the same).
uint32_t best_first_tier(const std::vector<uint64_t>& counts) {
  uint32_t best = 0;
  uint64_t fewest = 0;
  for (uint32_t levels = 1; levels <= kTierLevels; ++levels) {
    uint64_t subtrees = 1;
    for (size_t level = levels; level < counts.size(); level += kTierLevels)
      subtrees += counts[level];
    if (best != 0 && subtrees > fewest) continue;
    best = levels;
    fewest = subtrees;
  }
  return best;
}

uint32_t root_level(const Tiers& tiers, uint32_t tier) {
  return tier == 0 ? 0 : tiers.first_tier_levels + (tier - 1) * kTierLevels;
}

uint32_t level_start(const std::vector<uint32_t>& level_begin, uint32_t level) {
  return level_begin[std::min<size_t>(level, level_begin.size() - 1)];
}

// Of the subtrees with these roots: how many nodes each has.
std::vector<uint8_t> subtree_nodes(const Sizes& roots, uint32_t levels) {
  std::vector<uint8_t> nodes;
  nodes.reserve(roots.size());
  for (const uint32_t root : roots) {
    Sizes level{root};
    size_t count = 1;
    for (uint32_t i = 1; i < levels; ++i) count += (level = children_of(level)).size();
    nodes.push_back(static_cast<uint8_t>(count));
  }
  return nodes;
}

}  // namespace

std::vector<uint32_t> sizes_on_level(uint32_t gaussians, uint32_t level) {
  Sizes sizes{gaussians};
  for (uint32_t i = 0; i < level; ++i) sizes = children_of(sizes);
  return sizes;
}

uint32_t BakePlan::deepest_level(uint32_t gaussians) {
  uint32_t level = 0;
  for (Sizes sizes{gaussians}; level < 8; ++level) {
    sizes = children_of(sizes);
    if (sizes.empty() || *std::min_element(sizes.begin(), sizes.end()) < kLeastCell) break;
  }
  return level;
}

uint32_t BakePlan::largest_cell(uint32_t gaussians, uint32_t level) {
  const Sizes sizes = sizes_on_level(gaussians, level);
  return *std::max_element(sizes.begin(), sizes.end());
}

BakePlan::BakePlan(uint32_t gaussians, uint32_t cell_level, uint32_t chunk_bytes)
    : gaussians_(gaussians), cell_level_(cell_level), chunk_bytes_(chunk_bytes) {
  lay_out_levels();
  lay_out_cells();
  lay_out_segments();
}

void BakePlan::lay_out_levels() {
  const std::vector<uint64_t> counts = count_levels(gaussians_);
  first_tier_levels_ = best_first_tier(counts);
  level_begin_.push_back(0);
  for (const uint64_t count : counts)
    level_begin_.push_back(level_begin_.back() + static_cast<uint32_t>(count));
  for (size_t level = 0; level < counts.size();
       level += level == 0 ? first_tier_levels_ : kTierLevels) {
    tier_begin_.push_back(subtrees_);
    subtrees_ += static_cast<uint32_t>(counts[level]);
  }
  tier_begin_.push_back(subtrees_);
}

void BakePlan::lay_out_cells() {
  while (root_level(tiers(), first_cell_tier_) < cell_level_) ++first_cell_tier_;
  top_levels_ = std::max(root_level(tiers(), first_cell_tier_), cell_level_ + 1);
  cell_sizes_ = sizes_on_level(gaussians_, cell_level_);
  const size_t depth = level_begin_.size() - 1 - cell_level_;
  cell_node_.assign(depth, Sizes(cells()));
  Sizes next(level_begin_.begin() + cell_level_, level_begin_.end() - 1);
  for (uint32_t cell = 0; cell < cells(); ++cell) {
    const auto [shape, isnew] = shapes_.try_emplace(cell_sizes_[cell]);
    if (isnew) shape->second = shape_of(cell_sizes_[cell]);
    for (size_t level = 0; level < depth; ++level) {
      cell_node_[level][cell] = next[level];
      if (level < shape->second.levels.size()) next[level] += shape->second.levels[level];
    }
  }
}

BakePlan::CellShape BakePlan::shape_of(uint32_t size) const {
  CellShape shape;
  Sizes sizes{size};
  shape.tier_nodes.resize(tiers().tier_count() - first_cell_tier_);
  for (uint32_t level = 0; !sizes.empty(); ++level, sizes = children_of(sizes)) {
    shape.levels.push_back(static_cast<uint32_t>(sizes.size()));
    for (uint32_t tier = first_cell_tier_; tier < tiers().tier_count(); ++tier)
      if (cell_level_of(tier) == level)
        shape.tier_nodes[tier - first_cell_tier_] = subtree_nodes(sizes, kTierLevels);
  }
  return shape;
}

uint32_t BakePlan::cell_level_of(uint32_t tier) const {
  return root_level(tiers(), tier) - cell_level_;
}

uint32_t BakePlan::first_node(uint32_t cell, uint32_t level) const {
  return level < cell_node_.size() ? cell_node_[level][cell] : level_begin_.back();
}

SubtreePlace BakePlan::top_place(uint32_t tier) const {
  const uint32_t first = root_level(tiers(), tier);
  const uint32_t height = tier == 0 ? first_tier_levels_ : kTierLevels;
  SubtreePlace place{};
  for (uint32_t k = 0; k < 4; ++k)
    place.next[k] = level_start(level_begin_, first + std::min(k, height));
  return place;
}

void BakePlan::lay_out_segments() {
  subtrees_ = 0;
  for (uint32_t tier = 0; tier < tiers().tier_count(); ++tier) {
    tier_segment_.push_back(static_cast<uint32_t>(segments_.size()));
    if (tier < first_cell_tier_) {
      const uint32_t height = tier == 0 ? first_tier_levels_ : kTierLevels;
      const Sizes roots = sizes_on_level(gaussians_, root_level(tiers(), tier));
      add_segment(tier, kTop, top_place(tier), subtree_nodes(roots, height));
      continue;
    }
    for (uint32_t cell = 0; cell < cells(); ++cell) {
      SubtreePlace place{};
      for (uint32_t k = 0; k < 4; ++k) place.next[k] = first_node(cell, cell_level_of(tier) + k);
      const CellShape& shape = shapes_.at(cell_sizes_[cell]);
      add_segment(tier, cell, place, shape.tier_nodes[tier - first_cell_tier_]);
    }
  }
  tier_segment_.push_back(static_cast<uint32_t>(segments_.size()));
}

// Next-fit, as pack_runs() has it.
void BakePlan::add_segment(uint32_t tier, uint32_t cell, const SubtreePlace& place,
                           const std::vector<uint8_t>& nodes) {
  segments_.push_back({tier, cell, subtrees_, open_bytes_, chunk_count_, place});
  for (const uint8_t count : nodes) {
    const auto bytes = static_cast<uint32_t>(count * sizeof(NodeRecord));
    if (chunk_count_ == 0 || open_bytes_ + bytes > chunk_bytes_) {
      ++chunk_count_;
      open_bytes_ = 0;
    }
    open_bytes_ += bytes;
  }
  subtrees_ += static_cast<uint32_t>(nodes.size());
}

std::span<const Segment> BakePlan::segments(uint32_t tier) const {
  return std::span(segments_).subspan(tier_segment_[tier],
                                      tier_segment_[tier + 1] - tier_segment_[tier]);
}

}  // namespace voyager
