#pragma once
// What no chunk shows by itself: whether the tree goes on from one chunk to the next.
#include <deque>
#include <string>

#include "runtime/format/reader.h"

namespace voyager {

// For readers that see every chunk once and keep none. Loading and streaming check the same of the
// chunks that they hold.
class TreeCheck {
 public:
  // The file outlives the object.
  explicit TreeCheck(const SceneFile& file);

  // Of all chunks in order. Throws Error(refused_input) naming file, chunk and node where a box or
  // an extent is larger than its parent's, a repeated record is not its owner's, or the roots of
  // a subtree hang from several nodes.
  void add(const Chunk& chunk, uint32_t index);

 private:
  // A node whose children are roots of the next tier.
  struct Above {
    uint32_t first_child, child_count;
    NodeRecord record;
  };

  void check_subtree(const Subtree& subtree, const NodeRecord* records);
  void check_repeats(const Subtree& subtree, const NodeRecord* records);
  void check_roots(const Subtree& subtree, const NodeRecord* records);
  void check_inside(uint32_t node, const NodeRecord& child, const NodeRecord& parent) const;
  [[noreturn]] void refuse(uint32_t node, const char* found, const char* expected) const;

  const SceneFile& file_;
  const Tiers tiers_;
  uint32_t chunk_ = 0;
  NodeRecord root_{}, child_{};  // the last ones
  std::deque<Above> above_;      // nodes ascend, and so do their children
};

}  // namespace voyager
