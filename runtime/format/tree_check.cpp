#include "runtime/format/tree_check.h"

#include <algorithm>

#include "runtime/base/error.h"
#include "runtime/lod/nesting.h"

namespace voyager {

TreeCheck::TreeCheck(const SceneFile& file) : file_(file), tiers_(file.tiers()) {}

void TreeCheck::add(const Chunk& chunk, uint32_t index) {
  chunk_ = index;
  size_t record = 0, owned = 0;
  for (size_t i = 0; i < chunk.subtrees.size(); ++i) {
    const Subtree& subtree = chunk.subtrees[i];
    const bool first_tier = chunk.first_subtree + i < tiers_.tier_begin[1];
    const uint32_t levels = first_tier ? tiers_.first_tier_levels : kTierLevels;
    const NodeRecord* records = chunk.records.data() + record;
    check_subtree(subtree, records);
    for (uint32_t slot = subtree.first_owned_slot(); slot < subtree.node_count(); ++slot) {
      const uint32_t children = records[slot].child_count;
      if (subtree.level(slot) + 1 == levels && children != 0)
        above_.push_back({chunk.first_child[owned], children, records[slot]});
      ++owned;
    }
    record += subtree.node_count();
  }
}

void TreeCheck::check_subtree(const Subtree& subtree, const NodeRecord* records) {
  check_repeats(subtree, records);
  if (subtree.root != 0 && !subtree.repeats_root()) check_roots(subtree, records);
  each_family(
      subtree, [&](uint32_t slot) { return records[slot].child_count; },
      [&](uint32_t parent, uint32_t first, uint32_t count) {
        for (uint32_t slot = first; slot < first + count; ++slot)
          check_inside(subtree.node(slot), records[slot], records[parent]);
      });
}

void TreeCheck::check_repeats(const Subtree& subtree, const NodeRecord* records) {
  const char* const expected = "the record that the subtree before has of it";
  if (subtree.repeats_root() && !is_same(records[0], root_))
    refuse(subtree.root, "it repeated with another record", expected);
  if (subtree.repeats_child() && !is_same(records[1], child_))
    refuse(subtree.first_child, "it repeated with another record", expected);
  root_ = records[0];
  if (subtree.child_count != 0) child_ = records[subtree.first_child_slot()];
}

void TreeCheck::check_roots(const Subtree& subtree, const NodeRecord* records) {
  const uint32_t node = subtree.root;
  while (!above_.empty() && node - above_.front().first_child >= above_.front().child_count)
    above_.pop_front();
  if (above_.empty()) refuse(node, "no parent of it", "one in the tier above");
  const Above& parent = above_.front();
  if (subtree.root_count > parent.child_count - (node - parent.first_child))
    refuse(node, "a subtree with roots of several nodes", "roots of one");
  for (uint32_t slot = 0; slot < subtree.root_count; ++slot)
    check_inside(subtree.node(slot), records[slot], parent.record);
}

void TreeCheck::check_inside(uint32_t node, const NodeRecord& child,
                             const NodeRecord& parent) const {
  if (!is_inside(child, parent))
    refuse(node, "a larger box or extent than its parent's", "one inside it");
}

void TreeCheck::refuse(uint32_t node, const char* found, const char* expected) const {
  throw Error(ErrorCode::refused_input, file_.name() + ": chunk " + std::to_string(chunk_) +
                                            ": node " + std::to_string(node) + ": found " + found +
                                            ", expected " + expected);
}

}  // namespace voyager
