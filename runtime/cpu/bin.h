#pragma once
// The CPU's bin stage: which splats each tile draws, in depth order.
#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/base/workers.h"
#include "runtime/stages/bin.h"

namespace voyager::cpu {

class TileBins {
 public:
  explicit TileBins(std::pmr::memory_resource* memory)
      : counts_(memory), starts_(memory), pairs_(memory) {}

  // order: indices into splats, by depth. With the α-filter a tile gets the
  // splats whose ellipse reaches it, without it those whose box does.
  void build(const Splat* splats, std::span<const uint32_t> order, const TileGrid& grid,
             bool alpha_filter, Workers& workers);

  std::span<const uint32_t> tile(size_t index) const {
    return std::span(pairs_).subspan(starts_[index], starts_[index + 1] - starts_[index]);
  }
  uint64_t pairs_before() const { return pairs_before_; }
  uint64_t pairs_after() const { return pairs_after_; }

 private:
  std::pmr::vector<uint32_t> counts_;  // [block][tile], then where the block writes in the tile
  std::pmr::vector<uint64_t> starts_;  // [tile + 1]
  std::pmr::vector<uint32_t> pairs_;
  uint64_t pairs_before_ = 0, pairs_after_ = 0;
};

}  // namespace voyager::cpu
