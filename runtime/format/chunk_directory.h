#pragma once
// A file's chunk directory, as it is kept while the file is open: 33 bytes a chunk, where the file
// has 88. Chunks of more than 255 nodes, and the others of their blocks, have 121.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/format/layout.h"
#include "runtime/math/bounds_code.h"

namespace voyager {

// What is kept of a chunk's checksum, and compared.
constexpr uint32_t kept_checksum(uint64_t whole) {
  return static_cast<uint32_t>(whole);
}

class ChunkDirectory {
 public:
  // The next entry, which follows the one before it in bytes, subtrees and nodes, and has a sound
  // hull. An entry can be read after close().
  void add(const ChunkEntry& entry);
  // There are no more.
  void close();

  // Of all entries.
  struct Totals {
    uint64_t bytes = 0, nodes = 0, records = 0;
    uint32_t most_nodes = 0, most_records = 0;  // of a chunk

    bool operator==(const Totals&) const = default;
  };
  const Totals& totals() const { return totals_; }

  size_t size() const { return rows_.size(); }
  bool empty() const { return rows_.empty(); }
  // As the file has it, but for the hull, which is rounded as searches read it (bounds_code.h), and
  // for the upper half of the checksum, which is 0.
  ChunkEntry operator[](size_t chunk) const;
  ChunkEntry at(size_t chunk) const;  // throws std::out_of_range
  ChunkEntry front() const { return (*this)[0]; }
  ChunkEntry back() const { return (*this)[size() - 1]; }
  // All of it but the hull and the offset, in half the time.
  ChunkEntry numbers(size_t chunk) const;
  // Of its entry, at less cost.
  EntryHull hull(size_t chunk) const { return decode_bounds(hull_code(chunk)); }
  const BoundsCode& hull_code(size_t chunk) const { return rows_[chunk].hull; }
  SubtreePlace place(size_t chunk) const;
  // place().next[level].
  uint32_t next(size_t chunk, int level) const {
    const Block& block = blocks_[chunk / kBlockRows];
    if (block.wide != kPacked) return wide_[block.wide + chunk % kBlockRows].place.next[level];
    return block.next[level] + rows_[chunk].next[level];
  }
  uint32_t first_subtree(size_t chunk) const;
  uint32_t bytes(size_t chunk) const;
  // Whether its first subtree goes on with a root of the chunk before.
  bool goes_on_with_root(size_t chunk) const { return rows_[chunk].listed_children != 0; }

  class Iterator {
   public:
    Iterator(const ChunkDirectory* of, size_t chunk) : of_(of), chunk_(chunk) {}
    ChunkEntry operator*() const { return (*of_)[chunk_]; }
    Iterator& operator++() {
      ++chunk_;
      return *this;
    }
    bool operator==(const Iterator&) const = default;

   private:
    const ChunkDirectory* of_;
    size_t chunk_;
  };
  Iterator begin() const { return {this, 0}; }
  Iterator end() const { return {this, size()}; }

 private:
  static constexpr size_t kBlockRows = 32;
  static constexpr uint32_t kUnit = 64;  // bytes, of offsets and lengths
  static constexpr uint32_t kPacked = 0xffffffffu;

  // Numbers are counted from the block's.
  struct Row {
    uint32_t checksum;
    BoundsCode hull;
    uint16_t bytes;  // in units; the offset follows from those of the block's rows before
    uint16_t first_subtree;
    uint16_t next[4];  // SubtreePlace::next
    uint8_t node_count;
    uint8_t repeated;                               // records that are no nodes of its own
    uint8_t listed_children, listed_grandchildren;  // not 0 if the entry's is not
  };
  static_assert(sizeof(Row) == 32);
  struct Block {
    uint64_t offset;
    uint32_t next[4];
    uint32_t first_subtree;
    uint32_t wide;  // where wide_ has its entries, since some number is too large; or kPacked
  };

  struct Open {
    ChunkEntry entry;  // as the file has it
    BoundsCode hull;
  };

  uint64_t offset(size_t chunk) const;
  static bool pack(const Block& block, const Open& open, Row& row);
  void close_block();
  // The entry in wide_; null where it is packed.
  const ChunkEntry* wide(size_t chunk) const {
    const uint32_t at = blocks_[chunk / kBlockRows].wide;
    return at == kPacked ? nullptr : &wide_[at + chunk % kBlockRows];
  }

  std::vector<Row> rows_;
  std::vector<Block> blocks_;
  std::vector<ChunkEntry> wide_;
  std::vector<Open> open_;  // of the block that is being added
  uint32_t subtrees_ = 0;   // of all
  Totals totals_;
};

}  // namespace voyager
