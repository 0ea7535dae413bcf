#pragma once
// Bounds of the search records of a pool whose records lie on a device, by their addresses.
#include "runtime/stream/staged_chunk.h"

namespace voyager {

class RecordBounds {
 public:
  void make_room(uint32_t blocks) { codes_.assign(size_t{blocks} * kRecordBlock, {}); }
  // Of chunks with other blocks, several threads at once.
  void fill(const StagedChunk& chunk) {
    for (uint32_t i = 0; i < chunk.records.size(); ++i)
      codes_[chunk.record(i)] = chunk.records[i].code;
  }
  const BoundsCode& operator[](uint32_t record) const { return codes_[record]; }

 private:
  std::vector<BoundsCode> codes_;
};

}  // namespace voyager
