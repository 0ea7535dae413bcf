#include "runtime/lod/subtree_cursor.h"

#include <algorithm>

namespace voyager {
namespace {

uint32_t first_level(const Tiers& tiers, uint32_t tier) {
  return tier == 0 ? 0 : tiers.first_tier_levels + (tier - 1) * kTierLevels;
}

TierLevels levels_of(const Tiers& tiers, uint32_t tier) {
  const auto begin_of = [&](uint32_t level) {
    const auto last = static_cast<uint32_t>(tiers.level_begin.size()) - 1;
    return tiers.level_begin[std::min(level, last)];
  };
  const uint32_t first = first_level(tiers, tier);
  const uint32_t height = tier == 0 ? tiers.first_tier_levels : kTierLevels;
  TierLevels levels{height, {}, {}};
  for (uint32_t k = 0; k < 3; ++k) {
    levels.begin[k] = begin_of(first + std::min(k, height));
    levels.end[k] = begin_of(first + std::min(k + 1, height));
  }
  levels.begin[3] = begin_of(first + height);
  levels.end[3] = begin_of(first + height + 1);
  return levels;
}

// The tier that a place is in; tier_count() at the end, and where it is in none.
uint32_t tier_of(const Tiers& tiers, const SubtreePlace& place) {
  const uint32_t root = place.next[0] - (place.listed_children != 0 ? 1 : 0);
  const auto& begin = tiers.level_begin;
  if (root >= tiers.node_count()) return tiers.tier_count();
  const auto level =
      static_cast<uint32_t>(std::upper_bound(begin.begin(), begin.end(), root) - begin.begin() - 1);
  if (level == 0) return 0;
  if (level < tiers.first_tier_levels || (level - tiers.first_tier_levels) % kTierLevels != 0)
    return tiers.tier_count();
  return 1 + (level - tiers.first_tier_levels) / kTierLevels;
}

bool in_tier(const TierLevels& levels, const SubtreePlace& place) {
  for (int k = 0; k < 4; ++k)
    if (place.next[k] < levels.begin[k] || place.next[k] > levels.end[k]) return false;
  return place.listed_children <= place.next[1] - levels.begin[1] &&
         place.listed_grandchildren <= place.next[2] - levels.begin[2] &&
         (place.listed_grandchildren == 0 || place.listed_children != 0);
}

}  // namespace

uint32_t Tiers::count_of(uint32_t levels, uint32_t first_tier_levels) {
  if (levels <= first_tier_levels) return levels == 0 ? 0 : 1;
  return 1 + (levels - first_tier_levels + kTierLevels - 1) / kTierLevels;
}

void SubtreeCursor::start_tier(uint32_t tier) {
  tier_ = tier;
  place_ = SubtreePlace::end_of(tiers_);
  if (at_end()) return;
  levels_ = levels_of(tiers_, tier);
  std::copy_n(levels_.begin, 4, place_.next);
}

bool SubtreeCursor::move_to(uint32_t subtree, const SubtreePlace& place) {
  const uint32_t tier = tier_of(tiers_, place);
  if (tier == tiers_.tier_count()) {
    if (place != SubtreePlace::end_of(tiers_) || (tier != 0 && subtree != tiers_.tier_begin[tier]))
      return false;
    start_tier(tier);
  } else {
    const TierLevels levels = levels_of(tiers_, tier);
    const bool starts = std::equal(place.next, place.next + 4, levels.begin);
    if (!in_tier(levels, place) || starts != (subtree == tiers_.tier_begin[tier]) ||
        subtree < tiers_.tier_begin[tier] || subtree >= tiers_.tier_begin[tier + 1])
      return false;
    tier_ = tier;
    levels_ = levels;
    place_ = place;
  }
  subtree_ = subtree;
  return true;
}

const char* SubtreeCursor::take(const SubtreeCounts& counts, const NodeRecord* records,
                                Subtree& out) {
  if (at_end()) return "no tier left for it";
  if (counts.roots == 0) return "no root";
  if (uint32_t{counts.roots} + counts.children + counts.grandchildren > kSubtreeNodes)
    return "more than 31 nodes";
  out = {0,
         0,
         0,
         counts.roots,
         counts.children,
         counts.grandchildren,
         place_.listed_grandchildren != 0 ? Repeats::root_and_child
         : place_.listed_children != 0    ? Repeats::root
                                          : Repeats::nothing};
  const char* fault = take_roots(out);
  if (!fault) fault = take_children(records, out);
  if (!fault) fault = take_grandchildren(records, out);
  if (!fault) fault = take_below(records, out);
  return fault ? fault : finish(records, out);
}

const char* SubtreeCursor::take_roots(Subtree& out) {
  if (out.repeats_root()) {
    if (out.root_count != 1) return "other roots beside a run of one";
    out.root = place_.next[0] - 1;
    return nullptr;
  }
  if (out.root_count > levels_.end[0] - place_.next[0]) return "a root beyond its level";
  out.root = place_.next[0];
  place_.next[0] += out.root_count;
  return nullptr;
}

const char* SubtreeCursor::take_children(const NodeRecord* records, Subtree& out) {
  if (out.root_count > 1) return take_whole(records, 0, out);
  const uint32_t children = levels_.height > 1 ? records[0].child_count : 0;
  if (out.child_count == 0)
    return children == 0 && !out.repeats_root() ? nullptr : "no child of a root that has some";
  const uint32_t owned = out.child_count - (out.repeats_child() ? 1u : 0u);
  if (owned > children || place_.listed_children > children - owned)
    return "more children than its root has";
  if (children - place_.listed_children > levels_.end[1] - place_.next[1])
    return "more children than the next level has";
  first_children_[0] = place_.next[1];
  out.first_child = place_.next[1] - (out.repeats_child() ? 1u : 0u);
  place_.next[1] += owned;
  place_.listed_children += owned;
  return nullptr;
}

const char* SubtreeCursor::take_grandchildren(const NodeRecord* records, Subtree& out) {
  if (out.root_count > 1 || out.child_count != 1) {
    if (out.repeats_child()) return "other children beside a run of one";
    return take_whole(records, 1, out);
  }
  // The only child may be one of several runs.
  if (out.grandchild_count > levels_.end[2] - place_.next[2])
    return "more grandchildren than their level has";
  if (out.grandchild_count != 0) out.first_grandchild = place_.next[2];
  const uint32_t children = levels_.height > 2 ? records[1].child_count : 0;
  first_children_[1] = place_.next[2];
  const uint32_t unlisted = children - std::min(children, place_.listed_grandchildren);
  if (out.grandchild_count > unlisted) return "more grandchildren than its child has";
  if (unlisted > levels_.end[2] - place_.next[2]) return "more grandchildren than their level has";
  if (out.grandchild_count == 0 && children != 0) return "no child of a child that has some";
  if (out.grandchild_count == 0 && out.repeats_child()) return "no node of its own";
  place_.listed_grandchildren += out.grandchild_count;
  place_.next[2] += out.grandchild_count;
  return nullptr;
}

// The children of a level's nodes, all of each.
const char* SubtreeCursor::take_whole(const NodeRecord* records, uint32_t level, Subtree& out) {
  uint32_t& next = place_.next[level + 1];
  uint32_t left = level == 0 ? out.child_count : out.grandchild_count;
  if (left > levels_.end[level + 1] - next) return "more nodes than their level has";
  if (left != 0) (level == 0 ? out.first_child : out.first_grandchild) = next;
  for (uint32_t slot = out.first_slot(level); slot < out.first_slot(level + 1); ++slot) {
    const uint32_t children = levels_.height > level + 1 ? records[slot].child_count : 0;
    first_children_[slot] = next;
    if (children > left) return "fewer nodes than their parents have children";
    left -= children;
    next += children;
  }
  return left == 0 ? nullptr : "more nodes than their parents have children";
}

const char* SubtreeCursor::take_below(const NodeRecord* records, const Subtree& subtree) {
  const uint32_t begin = subtree.first_slot(levels_.height - 1);
  for (uint32_t slot = begin; slot < subtree.node_count(); ++slot) {
    const uint32_t children = records[slot].child_count;
    if (children > levels_.end[3] - place_.next[3]) return "more children than the level below has";
    first_children_[slot] = place_.next[3];
    place_.next[3] += children;
  }
  return nullptr;
}

// Whether the root goes on in another run, and the tier in another subtree.
const char* SubtreeCursor::finish(const NodeRecord* records, const Subtree& subtree) {
  const bool child_goes_on =
      place_.listed_grandchildren != 0 &&
      place_.listed_grandchildren < records[subtree.first_child_slot()].child_count;
  if (!child_goes_on) place_.listed_grandchildren = 0;
  if (!child_goes_on && place_.listed_children != 0 &&
      place_.listed_children == records[0].child_count)
    place_.listed_children = 0;
  ++subtree_;
  const bool levels_end = std::equal(place_.next, place_.next + 3, levels_.end);
  const bool tier_ends = levels_end && place_.listed_children == 0;
  if (tier_ends != (subtree_ == tiers_.tier_begin[tier_ + 1]))
    return "levels that do not end with the subtrees of their tier";
  if (!tier_ends) return nullptr;
  if (place_.next[3] != levels_.end[3]) return "fewer children than the level below has";
  start_tier(tier_ + 1);
  return nullptr;
}

namespace {

// Of each level in turn what lies between: visit(first, end).
template <class Visit>
void each_level_between(const Tiers& tiers, const SubtreePlace& from, const SubtreePlace& to,
                        const Visit& visit) {
  const uint32_t first = tier_of(tiers, from), last = tier_of(tiers, to);
  if (first > last) return;
  if (first == last)
    for (int k = 0; k < 4; ++k)
      if (to.next[k] < from.next[k]) return;
  for (uint32_t tier = first; tier <= last && tier < tiers.tier_count(); ++tier) {
    const TierLevels levels = levels_of(tiers, tier);
    for (int k = 0; k < 3; ++k) {
      const uint32_t begin = tier == first ? from.next[k] : levels.begin[k];
      const uint32_t end = tier == last ? to.next[k] : levels.end[k];
      if (begin != end) visit(begin, end);
    }
  }
}

}  // namespace

std::vector<NodeRange> nodes_between(const Tiers& tiers, const SubtreePlace& from,
                                     const SubtreePlace& to) {
  std::vector<NodeRange> ranges;
  each_level_between(tiers, from, to, [&](uint32_t begin, uint32_t end) {
    if (!ranges.empty() && ranges.back().first + ranges.back().count == begin)
      ranges.back().count += end - begin;
    else
      ranges.push_back({begin, end - begin});
  });
  return ranges;
}

uint64_t count_between(const Tiers& tiers, const SubtreePlace& from, const SubtreePlace& to) {
  uint64_t nodes = 0;
  each_level_between(tiers, from, to, [&](uint32_t begin, uint32_t end) { nodes += end - begin; });
  return nodes;
}

}  // namespace voyager
