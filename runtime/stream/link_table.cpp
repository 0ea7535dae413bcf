#include "runtime/stream/link_table.h"

#include <algorithm>

namespace voyager {
namespace {

// Of each level, the nodes that a subtree does not repeat.
std::array<uint32_t, 3> owned_nodes(uint32_t levels) {
  const uint32_t first_child = levels & 0xff, first_grandchild = levels >> 8 & 0xff;
  const uint32_t repeated = levels >> 24 & 3;
  return {first_child - (repeated != 0 ? 1 : 0),
          first_grandchild - first_child - (repeated == 2 ? 1 : 0),
          (levels >> 16 & 0xff) - first_grandchild};
}

}  // namespace

LinkTable::LinkTable(std::span<const Part> parts, std::span<const uint32_t> child_counts)
    : subtrees_(static_cast<uint32_t>(parts.size())),
      nodes_below_(static_cast<uint32_t>(child_counts.size())) {
  for (const Part& part : parts) slots_ += part.levels >> 16 & 0xff;
  words_ = std::make_unique<uint32_t[]>(word_count());
  uint32_t before = 0;
  for (uint32_t i = 0; i < subtrees_; ++i) {
    words_[i] = parts[i].levels;
    put_bits(subtrees_, before, parts[i].interior);
    put_bits(subtrees_ + bit_words(), before, parts[i].families);
    before += parts[i].levels >> 16 & 0xff;
  }
  for (uint32_t below = 0; below < nodes_below_; ++below)
    words_[below_at() + below / 4] |= std::min(child_counts[below], kManyChildren)
                                      << 8 * (below % 4);
}

void LinkTable::put_bits(uint32_t from, uint32_t before, uint32_t slots) {
  const uint64_t two = uint64_t{slots} << before % 32;
  words_[from + before / 32] |= static_cast<uint32_t>(two);
  words_[from + before / 32 + 1] |= static_cast<uint32_t>(two >> 32);
}

LinkWalk::LinkWalk(const LinkTable& table, const Tiers& tiers, LargeFamilies large)
    : table_(&table),
      tiers_(&tiers),
      large_(large),
      next_root_(table.next_root),
      next_below_(table.next_below) {
  const auto& begin = tiers.tier_begin;
  tier_ = static_cast<uint32_t>(std::upper_bound(begin.begin(), begin.end(), table.first_subtree) -
                                begin.begin() - 1);
  start_tier();
}

// Nodes lie in a slot by their ids: those of a tier level by level.
void LinkWalk::start_tier() {
  height_ = tier_ == 0 ? tiers_->first_tier_levels : kTierLevels;
  tier_end_ = std::min(table_->subtrees(), tiers_->tier_begin[tier_ + 1] - table_->first_subtree);
  std::array<uint32_t, 3> owned{};
  for (uint32_t i = index_; i < tier_end_; ++i) {
    const std::array<uint32_t, 3> of = owned_nodes(table_->levels(i));
    for (uint32_t level = 0; level < 3; ++level) owned[level] += of[level];
  }
  place_ = {nodes_, nodes_ + owned[0], nodes_ + owned[0] + owned[1]};
  nodes_ += owned[0] + owned[1] + owned[2];
  read();
}

void LinkWalk::read() {
  levels_ = table_->levels(index_);
  interior_ = table_->interior(slots_, slot_count());
  below_end_ = next_below_;
  for (NodesBelow below(*this); !below.at_end(); below.next()) below_end_ = below.children_end();
}

void LinkWalk::next() {
  const std::array<uint32_t, 3> owned = owned_nodes(levels_);
  next_below_ = below_end_;
  next_root_ += owned[0];
  for (uint32_t level = 0; level < 3; ++level) place_[level] += owned[level];
  below_ += count_bits(lowest());
  record_ += count_bits(interior_);
  slots_ += slot_count();
  if (++index_ == table_->subtrees()) return;
  if (index_ != tier_end_) return read();
  ++tier_;
  const uint32_t level = tiers_->first_tier_levels + (tier_ - 1) * kTierLevels;
  const auto& begin = tiers_->level_begin;
  next_root_ = begin[level];
  next_below_ = begin[std::min<size_t>(level + kTierLevels, begin.size() - 1)];
  start_tier();
}

}  // namespace voyager
