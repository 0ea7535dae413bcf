#pragma once
// What a frame draws of a scene, in the order of ids: the cut with its weights, or every
// leaf. Shared by the backends that run on the host.
#include <memory_resource>
#include <optional>
#include <vector>

#include "runtime/base/workers.h"
#include "runtime/frame/backend.h"
#include "runtime/frame/host_search.h"

namespace voyager {

class DrawList {
 public:
  DrawList(std::shared_ptr<const Scene> scene, Lod lod, Search search,
           std::pmr::memory_resource* memory, Workers& workers);

  // Throws Error(damaged_chunk) where the frame needs a node that is not there. After a call
  // that threw, the next is right all the same.
  void update(const CutQuery& query, Workers& workers);

  // Index in items() is the tie-breaker of the sort: node ids ascend in a cut,
  // input indices where every leaf is drawn.
  const std::pmr::vector<DrawItem>& items() const { return search_ ? search_->items() : leaves_; }
  // Node ids, ascending; none where every leaf is drawn.
  void read_cut(std::pmr::vector<uint32_t>& nodes) const {
    nodes.clear();
    if (search_) search_->read_cut(nodes);
  }
  // Adds its counters.
  void collect(FrameStats& stats) const;

 private:
  void list_leaves();

  std::shared_ptr<const Scene> scene_;
  std::optional<HostSearch> search_;  // none where every leaf is drawn
  std::pmr::vector<DrawItem> leaves_;
  bool leaves_missing_ = false;
};

}  // namespace voyager
