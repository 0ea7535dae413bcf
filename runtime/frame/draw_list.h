#pragma once
// What a frame draws, in the order of ids: the cut with its weights, or every
// leaf. Shared by the backends that run on the host.
#include <memory_resource>
#include <vector>

#include "runtime/base/workers.h"
#include "runtime/frame/backend.h"
#include "runtime/select/cut.h"
#include "runtime/stages/interpolate.h"

namespace voyager {

class DrawList {
 public:
  DrawList(std::shared_ptr<const Scene> scene, Lod lod, std::pmr::memory_resource* memory);

  // Throws Error(damaged_chunk) where the frame needs a node that is not there.
  void update(const FrameInput& frame, Workers& workers);

  // Index in items() is the tie-breaker of the sort: node ids ascend in a cut,
  // input indices where every leaf is drawn.
  const std::pmr::vector<DrawItem>& items() const { return items_; }
  const std::pmr::vector<uint32_t>& cut() const { return search_.cut(); }
  void collect(FrameStats& stats) const;

 private:
  void list_leaves();
  [[noreturn]] void refuse_damaged(uint32_t node) const;

  std::shared_ptr<const Scene> scene_;
  Lod lod_;
  std::vector<MissingNodes> missing_;
  ExhaustiveSearch search_;
  std::pmr::vector<DrawItem> items_;
  bool leaves_missing_ = false;
};

GaussianArrays gaussian_arrays(const Scene& scene);

}  // namespace voyager
