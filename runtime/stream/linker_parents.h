#pragma once
#include <optional>

#include "runtime/stream/linker.h"

namespace voyager {

// What the roots of one chunk hang from: goes through the nodes of one chunk after another.
class Linker::Parents {
 public:
  // own: the chunk, where it is not held yet, or null.
  Parents(const Linker& linker, uint32_t below, const StagedChunk* own)
      : linker_(linker), below_(below), own_(own) {}

  // Null: the chunk that should lead to it does not.
  const Parent* of(uint32_t root) {
    if (found_ && root < found_->end()) return &*found_;
    found_.reset();
    if (!walk_ || root >= end_) go_to(linker_.graph_->owner_of_parent(below_, root));
    LinkWalk& at = walk_->at;
    if (!at.at_end() && at.below_end() <= root) {
      while (!at.at_end() && at.below_end() <= root) at.next();
      if (!at.at_end()) nodes_.emplace(at);
    }
    if (at.at_end()) return nullptr;
    while (nodes_->children_end() <= root) nodes_->next();
    if (root < nodes_->children_begin()) return nullptr;
    const NodeBelow node = **nodes_;
    found_ = Parent{walk_->chunk, at.index(), walk_->records(node.record), node};
    return &*found_;
  }

 private:
  void go_to(uint32_t chunk) {
    const bool is_own = chunk == below_;
    walk_.emplace(is_own && own_ != nullptr ? linker_.walk(*own_) : linker_.walk(chunk));
    nodes_.emplace(walk_->at);
    end_ = is_own ? UINT32_MAX : linker_.graph_->next_below(chunk + 1);
  }

  const Linker& linker_;
  const uint32_t below_;
  const StagedChunk* own_;
  std::optional<Walk> walk_;
  std::optional<LinkWalk::NodesBelow> nodes_;
  uint32_t end_ = 0;  // roots before this one hang from that chunk
  std::optional<Parent> found_;
};

}  // namespace voyager
