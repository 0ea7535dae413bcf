#pragma once
// Bounds of search records on the host, of a pool whose records lie on a device: those that chunks
// which come later are checked against (StagedChunk::checked).
#include <memory>
#include <vector>

#include "runtime/stream/staged_chunk.h"

namespace voyager {

class RecordBounds {
 public:
  void make_room(uint32_t slots) { codes_ = decltype(codes_)(slots); }
  // Of chunks with other slots, several threads at once.
  void fill(const StagedChunk& chunk) {
    auto codes = std::make_unique<BoundsCode[]>(chunk.checked.size());
    for (size_t i = 0; i < chunk.checked.size(); ++i)
      codes[i] = chunk.records[chunk.checked[i]].code;
    codes_[chunk.links.slot] = std::move(codes);
  }
  const BoundsCode& at(uint32_t slot, uint32_t checked) const { return codes_[slot][checked]; }

 private:
  std::vector<std::unique_ptr<BoundsCode[]>> codes_;  // by slot
};

}  // namespace voyager
