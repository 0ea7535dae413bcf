#include "runtime/bake/plan.h"

#include <algorithm>

#include "runtime/lod/shape.h"

namespace voyager {
namespace {

// Nodes that a node above the cells has so many levels below it, down to their roots.
uint32_t nodes_below(uint32_t levels) {
  uint32_t nodes = 1;
  while (levels-- > 0) nodes *= kChildren;
  return nodes;
}

// The first tier that leaves the fewest subtrees, of which there is one a root before siblings
// share them; of several, that of most levels (runtime/lod/subtrees.cpp chooses the same).
uint32_t best_first_tier(const std::vector<uint32_t>& level_begin) {
  uint32_t best = 0;
  uint64_t fewest = 0;
  for (uint32_t levels = 1; levels <= kTierLevels; ++levels) {
    uint64_t subtrees = 1;
    for (size_t level = levels; level + 1 < level_begin.size(); level += kTierLevels)
      subtrees += level_begin[level + 1] - level_begin[level];
    if (best != 0 && subtrees > fewest) continue;
    best = levels;
    fewest = subtrees;
  }
  return best;
}

uint32_t tier_height(const Tiers& tiers, uint32_t tier) {
  return tier == 0 ? tiers.first_tier_levels : kTierLevels;
}

uint32_t root_level(const Tiers& tiers, uint32_t tier) {
  return tier == 0 ? 0 : tiers.first_tier_levels + (tier - 1) * kTierLevels;
}

}  // namespace

BakePlan::BakePlan(uint32_t cell_level, uint32_t chunk_bytes, const ShapeOf& shape_of,
                   Workers& workers)
    : cell_level_(cell_level), cells_(nodes_below(cell_level)), chunk_bytes_(chunk_bytes) {
  Lists levels(cells_);
  workers.for_blocks(cells_, 1, [&](size_t cell, size_t) {
    levels[cell] = cell_levels(shape_of(static_cast<uint32_t>(cell)));
  });
  lay_out_levels(levels);
  lay_out_tiers();
  lay_out_segments(shape_of, workers);
}

void BakePlan::lay_out_levels(const Lists& cell_levels) {
  level_begin_.push_back(0);
  for (uint32_t level = 0; level < cell_level_; ++level)
    level_begin_.push_back(level_begin_.back() + nodes_below(level));
  size_t depth = 0;
  for (const auto& levels : cell_levels) depth = std::max(depth, levels.size() - 1);
  for (size_t level = 0; level < depth; ++level) {
    uint32_t next = level_begin_.back();
    std::vector<uint32_t> first;
    for (const auto& levels : cell_levels) {
      first.push_back(next);
      if (level + 1 < levels.size()) next += levels[level + 1] - levels[level];
    }
    first.push_back(next);
    cell_node_.push_back(std::move(first));
    level_begin_.push_back(next);
  }
}

void BakePlan::lay_out_tiers() {
  first_tier_levels_ = best_first_tier(level_begin_);
  while (root_level(tiers(), first_cell_tier_) < cell_level_) ++first_cell_tier_;
  top_levels_ = std::max(root_level(tiers(), first_cell_tier_), cell_level_ + 1);
}

uint32_t BakePlan::cell_level_of(uint32_t tier) const {
  return root_level(tiers(), tier) - cell_level_;
}

uint32_t BakePlan::first_node(uint32_t cell, uint32_t level) const {
  return level < cell_node_.size() ? cell_node_[level][cell] : level_begin_.back();
}

SubtreePlace BakePlan::top_place(uint32_t tier) const {
  const uint32_t first = root_level(tiers(), tier), height = tier_height(tiers(), tier);
  SubtreePlace place{};
  for (uint32_t k = 0; k < 4; ++k) place.next[k] = level_begin_[first + std::min(k, height)];
  return place;
}

// They share no subtree: each has grandchildren in its tier (cell_shape.h).
std::vector<RootShape> BakePlan::top_shapes(uint32_t tier) const {
  const uint32_t first = root_level(tiers(), tier), end = first + tier_height(tiers(), tier);
  std::vector<RootShape> roots(nodes_below(first));
  const uint32_t cells = nodes_below(cell_level_ - first);  // below each root
  for (uint32_t root = 0; root < roots.size(); ++root) {
    uint32_t count = 0;
    for (uint32_t level = first; level < end; ++level)
      count += level <= cell_level_ ? nodes_below(level - first)
                                    : first_node((root + 1) * cells, level - cell_level_) -
                                          first_node(root * cells, level - cell_level_);
    roots[root].nodes = static_cast<uint8_t>(count) & 31u;
  }
  return roots;
}

void BakePlan::lay_out_segments(const ShapeOf& shape_of, Workers& workers) {
  const auto depth = static_cast<uint32_t>(level_begin_.size() - 1);
  const uint32_t tier_count = Tiers::count_of(depth, first_tier_levels_);
  std::vector<std::vector<std::vector<RootShape>>> cell_roots(cells_);  // of each cell tier
  workers.for_blocks(cells_, 1, [&](size_t cell, size_t) {
    const std::vector<uint8_t> shape = shape_of(static_cast<uint32_t>(cell));
    const std::vector<uint32_t> levels = cell_levels(shape);
    for (uint32_t tier = first_cell_tier_; tier < tier_count; ++tier)
      cell_roots[cell].push_back(root_shapes(shape, levels, cell_level_of(tier)));
  });
  for (uint32_t tier = 0; tier < tier_count; ++tier) {
    tier_segment_.push_back(static_cast<uint32_t>(segments_.size()));
    tier_begin_.push_back(subtrees_);
    if (tier < first_cell_tier_) {
      add_segment(tier, kTop, top_place(tier), top_shapes(tier));
      continue;
    }
    for (uint32_t cell = 0; cell < cells_; ++cell) {
      SubtreePlace place{};
      for (uint32_t k = 0; k < 4; ++k) place.next[k] = first_node(cell, cell_level_of(tier) + k);
      add_segment(tier, cell, place, cell_roots[cell][tier - first_cell_tier_]);
    }
  }
  tier_segment_.push_back(static_cast<uint32_t>(segments_.size()));
  tier_begin_.push_back(subtrees_);
}

// Next-fit, as pack_runs() has it; then siblings share, as join_siblings() has it. A segment's
// first root shares with none before it.
void BakePlan::add_segment(uint32_t tier, uint32_t cell, const SubtreePlace& place,
                           const std::vector<RootShape>& roots) {
  segments_.push_back({tier, cell, subtrees_, open_bytes_, chunk_count_, place});
  SiblingRule rule;
  for (const RootShape& root : roots) {
    const auto bytes = static_cast<uint32_t>(root.nodes * sizeof(NodeRecord));
    if (chunk_count_ == 0 || open_bytes_ + bytes > chunk_bytes_) {
      ++chunk_count_;
      open_bytes_ = 0;
      rule.start();
    }
    open_bytes_ += bytes;
    subtrees_ += rule.shares(root.nodes, root.sibling, root.deep) ? 0 : 1;
  }
}

std::span<const Segment> BakePlan::segments(uint32_t tier) const {
  return std::span(segments_).subspan(tier_segment_[tier],
                                      tier_segment_[tier + 1] - tier_segment_[tier]);
}

}  // namespace voyager
