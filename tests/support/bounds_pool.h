#pragma once
// A pool of a linker's: it knows the bounds of what it is filled with, and nothing else.
#include "runtime/stream/chunk_pool.h"
#include "runtime/stream/record_bounds.h"

namespace voyager::test {

class BoundsPool final : public ChunkPool {
 public:
  explicit BoundsPool(uint32_t slots) { bounds_.make_room(slots); }
  void fill(std::span<const StagedChunk* const> chunks) override {
    for (const StagedChunk* chunk : chunks) bounds_.fill(*chunk);
  }
  const BoundsCode& bounds(const CheckedRecord& of) const override {
    return bounds_.at(of.slot, of.checked);
  }
  void apply(const LinkPatch&) override {}
  void resize(PoolRoom) override {}

 private:
  RecordBounds bounds_;
};

}  // namespace voyager::test
