#include "runtime/stream/link_table.h"

#include <algorithm>

namespace voyager {

LinkTable::LinkTable(std::span<const Part> parts, std::span<const uint32_t> child_counts)
    : subtrees_(static_cast<uint32_t>(parts.size())),
      nodes_below_(static_cast<uint32_t>(child_counts.size())) {
  for (const Part& part : parts) slots_ += part.levels >> 16 & 0xff;
  words_ = std::make_unique<std::atomic<uint32_t>[]>(word_count());
  uint32_t before = 0;
  for (uint32_t i = 0; i < subtrees_; ++i) {
    set_bits(i, parts[i].levels);
    put_bits(subtrees_, before, parts[i].interior);
    put_bits(subtrees_ + bit_words(), before, parts[i].families);
    before += parts[i].levels >> 16 & 0xff;
  }
  for (uint32_t below = 0; below < nodes_below_; ++below)
    set_bits(below_at() + below / 4, std::min(child_counts[below], kManyChildren)
                                         << 8 * (below % 4));
}

// A load and a store: no other thread has the table yet.
void LinkTable::set_bits(size_t at, uint32_t bits) {
  words_[at].store(word(at) | bits, std::memory_order_relaxed);
}

void LinkTable::put_bits(uint32_t from, uint32_t before, uint32_t slots) {
  const uint64_t two = uint64_t{slots} << before % 32;
  set_bits(from + before / 32, static_cast<uint32_t>(two));
  set_bits(from + before / 32 + 1, static_cast<uint32_t>(two >> 32));
}

RootWalk::RootWalk(const LinkTable& table, const Tiers& tiers)
    : table_(&table), tiers_(&tiers), levels_(table.levels(0)), next_root_(table.next_root) {
  const auto& begin = tiers.tier_begin;
  tier_ = static_cast<uint32_t>(std::upper_bound(begin.begin(), begin.end(), table.first_subtree) -
                                begin.begin() - 1);
  find_tier_end();
}

void RootWalk::find_tier_end() {
  tier_end_ = std::min(table_->subtrees(), tiers_->tier_begin[tier_ + 1] - table_->first_subtree);
}

void RootWalk::next() {
  next_root_ += owned(levels_).roots;
  if (++index_ == table_->subtrees()) return;
  if (index_ == tier_end_) {
    ++tier_;
    find_tier_end();
    next_root_ = tiers_->level_begin[level()];
  }
  levels_ = table_->levels(index_);
}

LinkWalk::LinkWalk(const LinkTable& table, const Tiers& tiers, LargeFamilies large)
    : RootWalk(table, tiers), large_(large), next_below_(table.next_below) {
  start_tier();
}

// Nodes lie in a slot by their ids: those of a tier level by level.
void LinkWalk::start_tier() {
  height_ = tier_ == 0 ? tiers_->first_tier_levels : kTierLevels;
  uint32_t roots = 0, children = 0, grandchildren = 0;
  for (uint32_t i = index_; i < tier_end_; ++i) {
    const Owned of = owned(table_->levels(i));
    roots += of.roots;
    children += of.children;
    grandchildren += of.grandchildren;
  }
  place_ = {nodes_, nodes_ + roots, nodes_ + roots + children};
  nodes_ += roots + children + grandchildren;
  read();
}

void LinkWalk::read() {
  interior_ = table_->interior(slots_, slot_count());
  below_end_ = next_below_;
  for (NodesBelow below(*this); !below.at_end(); below.next()) below_end_ = below.children_end();
}

void LinkWalk::next() {
  const Owned of = owned(levels_);
  place_ = {place_[0] + of.roots, place_[1] + of.children, place_[2] + of.grandchildren};
  next_below_ = below_end_;
  below_ += count_bits(lowest());
  record_ += count_bits(interior_);
  slots_ += slot_count();
  const uint32_t tier = tier_;
  RootWalk::next();
  if (at_end()) return;
  if (tier_ == tier) return read();
  const auto& begin = tiers_->level_begin;
  next_below_ = begin[std::min<size_t>(level() + kTierLevels, begin.size() - 1)];
  start_tier();
}

}  // namespace voyager
