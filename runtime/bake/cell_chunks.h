#pragma once
// The chunks of one cell in a file of its own: bytes, then of each cell tier what the
// directory and the neighbouring cells need.
#include "runtime/bake/segment.h"
#include "runtime/bake/top_tree.h"

namespace voyager {

// Rebuilds the cell, turns its axes below the top's, encodes it. Its rows and leaves
// are then no longer needed, and removed.
void encode_cell(const SplitInfo& split, const BakePlan& plan, const BakedScene& top,
                 Quality quality, uint32_t cell, const WorkFolder& folder, Workers& workers);

class CellChunks {
 public:
  // Throws Error(refused_input) where the file was altered.
  CellChunks(const BakePlan& plan, uint32_t cell, const WorkFolder& folder);

  // `index` counts cell tiers. Also where the bytes of its whole chunks start.
  EncodedSegment read_tier(uint32_t index) const;
  uint64_t bytes_of_tier(uint32_t index) const { return tiers_.at(index).chunks_at; }
  const ByteSource& source() const { return *source_; }

  struct TierPart {
    uint64_t chunks_at;  // in the file
    uint64_t about_at, about_bytes, about_sum;
  };

 private:
  std::unique_ptr<ByteSource> source_;
  std::vector<TierPart> tiers_;
};

// What chunks share, for the encoder.
ChunkContext encoding_context(const SplitInfo& split, Quality quality);

}  // namespace voyager
