#pragma once
// A pool that keeps only bounds, for tests of Linker: by address as a host's does, and as a
// device's.
#include <gtest/gtest.h>

#include <map>

#include "runtime/stream/chunk_pool.h"
#include "runtime/stream/record_bounds.h"

namespace voyager::test {

class BoundsPool final : public ChunkPool {
 public:
  explicit BoundsPool(uint32_t slots) { bounds_.make_room(slots); }
  void fill(std::span<const StagedChunk* const> chunks) override {
    for (const StagedChunk* chunk : chunks) {
      bounds_.fill(*chunk);
      for (uint32_t i = 0; i < chunk->records.size(); ++i)
        codes_[chunk->record(i)] = chunk->records[i].code;
    }
  }
  const BoundsCode& bounds(const CheckedRecord& of) const override {
    const BoundsCode& code = codes_.at(of.record);
    EXPECT_EQ(bounds_.at(of.slot, of.checked), code);
    return code;
  }
  void apply(const LinkPatch&) override {}
  void resize(PoolRoom) override {}

 private:
  RecordBounds bounds_;
  std::map<uint32_t, BoundsCode> codes_;
};

}  // namespace voyager::test
