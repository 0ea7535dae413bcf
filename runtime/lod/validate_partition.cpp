#include <limits>

#include "runtime/lod/findings.h"
#include "runtime/lod/subtree_cursor.h"

namespace voyager {
namespace {

std::string name_of(const char* what, size_t index) {
  return std::string(what) + " " + std::to_string(index);
}

// Ascending from 0 to `end`, without an empty range; nothing at all where `end` is 0.
void check_begins(const char* what, std::span<const uint32_t> begin, size_t end,
                  Findings& findings) {
  if (begin.empty()) return findings.check_equal(std::string(what) + " ends", size_t{0}, end);
  for (size_t i = 1; i < begin.size(); ++i)
    if (begin[i] <= begin[i - 1])
      findings.add(name_of(what, i), std::to_string(begin[i]),
                   "more than " + std::to_string(begin[i - 1]));
  findings.check_equal(name_of(what, 0), size_t{begin.front()}, size_t{0});
  findings.check_equal(std::string(what) + " ends", size_t{begin.back()}, end);
}

void check_tables(const Partition& p, const LodTree& tree, Findings& findings) {
  check_begins("level", p.level_begin, tree.size(), findings);
  check_begins("tier", p.tier_begin, p.subtrees.size(), findings);
  check_begins("chunk", p.chunk_begin, p.subtrees.size(), findings);
  findings.check_equal("entry hulls", p.chunk_hull.size(), p.chunk_count());
  if (tree.size() == 0) return;
  if (p.first_tier_levels < 1 || p.first_tier_levels > kTierLevels)
    return findings.add("levels of the first tier", std::to_string(p.first_tier_levels), "1 to 3");
  if (p.level_begin.empty() || p.tier_begin.empty()) return;
  const auto levels = static_cast<uint32_t>(p.level_begin.size() - 1);
  findings.check_equal("tiers", p.tier_begin.size() - 1,
                       size_t{Tiers::count_of(levels, p.first_tier_levels)});
}

// Reads the subtrees from nothing but their counts and the tree's records.
void check_subtrees(const Partition& p, const LodTree& tree, Findings& findings) {
  SubtreeCursor cursor(tiers_of(p));
  for (size_t i = 0; i < p.subtrees.size() && !findings.full(); ++i) {
    const Subtree& found = p.subtrees[i];
    NodeRecord records[kSubtreeNodes];
    for (uint32_t slot = 0; slot < found.node_count(); ++slot) {
      if (slot == kSubtreeNodes || found.node(slot) >= tree.size())
        return findings.add(name_of("subtree", i), "nodes that cannot be",
                            "at most 31 of the tree");
      records[slot] = tree.records[found.node(slot)];
    }
    Subtree expected{};
    const char* fault = cursor.take(counts_of(found), records, expected);
    if (fault) return findings.add(name_of("subtree", i), fault, "a sound one");
    if (found != expected)
      return findings.add(
          name_of("subtree", i), "root " + std::to_string(found.root),
          "the nodes that follow those before it, from root " + std::to_string(expected.root));
    for (uint32_t slot = found.first_owned_slot(); slot < found.node_count(); ++slot)
      if (records[slot].child_count != 0)
        findings.check_equal(name_of("first child of node", found.node(slot)),
                             cursor.first_children()[slot], tree.first_child[found.node(slot)]);
    for (uint32_t slot = 1; slot < found.root_count; ++slot)
      if (tree.parent[found.node(slot)] != tree.parent[found.root])
        findings.add(name_of("subtree", i), "roots of several nodes", "of one");
  }
  if (!cursor.at_end()) findings.add("subtrees", "nodes left over", "each node in one");
}

void check_chunk(const Partition& p, const LodTree& tree, size_t index, Findings& findings) {
  size_t bytes = 0;
  const EntryHull& hull = p.chunk_hull[index];
  for (uint32_t i = p.chunk_begin[index]; i < p.chunk_begin[index + 1]; ++i) {
    const Subtree& subtree = p.subtrees[i];
    bytes += subtree.node_count() * sizeof(NodeRecord);
    const uint32_t parent = tree.parent[subtree.first_owned()];
    bool covered = hull.extent == std::numeric_limits<float>::infinity();
    if (parent != kNoNode) {
      const NodeRecord& r = tree.records[parent];
      covered = hull.extent >= r.extent;
      for (int axis = 0; axis < 3; ++axis)
        covered &= hull.box_min[axis] <= r.box_min[axis] && hull.box_max[axis] >= r.box_max[axis];
    }
    if (!covered)
      findings.add(name_of("chunk", index),
                   "an entry hull without the parent of subtree " + std::to_string(i), "with it");
  }
  if (bytes > p.chunk_bytes)
    findings.add(name_of("chunk", index), std::to_string(bytes) + " bytes of records",
                 "at most " + std::to_string(p.chunk_bytes));
}

}  // namespace

std::vector<std::string> validate(const Partition& partition, const LodTree& tree, size_t limit) {
  Findings findings(limit);
  check_tables(partition, tree, findings);
  std::vector<std::string> broken = findings.take();
  if (!broken.empty() || tree.size() == 0) return broken;
  check_subtrees(partition, tree, findings);
  broken = findings.take();
  if (!broken.empty()) return broken;
  for (size_t i = 0; i < partition.chunk_count() && !findings.full(); ++i)
    check_chunk(partition, tree, i, findings);
  return findings.take();
}

}  // namespace voyager
