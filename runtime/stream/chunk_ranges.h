#pragma once
// A range of chunks for each chunk, in four bytes where ranges of chunks side by side are.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voyager {

// Chunks [first, last).
struct ChunkRange {
  uint32_t first, last;
  bool empty() const { return first == last; }
};

class ChunkRanges {
 public:
  // The next chunk's. An empty one is kept as an empty one, wherever it is.
  void add(ChunkRange range);
  // There are no more.
  void close();

  size_t size() const { return rows_.size(); }
  // After close().
  ChunkRange operator[](size_t chunk) const {
    const Block& block = blocks_[chunk / kBlockRows];
    if (block.wide != kPacked) return wide_[block.wide + chunk % kBlockRows];
    const uint32_t first = block.first + rows_[chunk].first;
    return {first, first + rows_[chunk].count};
  }
  bool is_empty(size_t chunk) const { return rows_[chunk].count == 0; }

 private:
  static constexpr size_t kBlockRows = 64;
  static constexpr uint32_t kPacked = 0xffffffffu;

  struct Row {
    uint16_t first, count;  // first: counted from the block's; count: 0 only if the range is empty
  };
  struct Block {
    uint32_t first;
    uint32_t wide;  // where wide_ has its ranges, since some number is too large; or kPacked
  };

  void close_block();

  std::vector<Row> rows_;
  std::vector<Block> blocks_;
  std::vector<ChunkRange> wide_;
  std::vector<ChunkRange> open_;  // of the block that is being added
};

}  // namespace voyager
