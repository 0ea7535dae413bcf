#include "runtime/format/chunk_directory.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace voyager {
namespace {

// False where it is too large; then it is the largest.
template <class Small>
bool narrow(uint64_t value, Small& out) {
  constexpr uint64_t kMost = std::numeric_limits<Small>::max();
  out = static_cast<Small>(std::min(value, kMost));
  return value <= kMost;
}

}  // namespace

void ChunkDirectory::add(const ChunkEntry& entry) {
  static_assert(chunk_align(Quality::lossless) % kUnit == 0 &&
                chunk_align(Quality::compact) % kUnit == 0);
  open_.push_back({entry, encode_bounds(entry.hull)});
  subtrees_ = entry.first_subtree + entry.subtree_count;
  totals_ = {totals_.bytes + entry.bytes, totals_.nodes + entry.node_count,
             totals_.records + entry.record_count, std::max(totals_.most_nodes, entry.node_count),
             std::max(totals_.most_records, entry.record_count)};
  if (open_.size() == kBlockRows) close_block();
}

void ChunkDirectory::close() {
  close_block();
  open_ = {};
  rows_.shrink_to_fit();
  blocks_.shrink_to_fit();
  wide_.shrink_to_fit();
}

bool ChunkDirectory::pack(const Block& block, const Open& open, Row& row) {
  const ChunkEntry& entry = open.entry;
  row.checksum = kept_checksum(entry.checksum);
  row.hull = open.hull;
  bool fits = narrow(entry.place.listed_children, row.listed_children);
  fits &= narrow(entry.place.listed_grandchildren, row.listed_grandchildren);
  fits &= narrow(entry.bytes / kUnit, row.bytes);
  fits &= narrow(entry.first_subtree - block.first_subtree, row.first_subtree);
  fits &= narrow(entry.node_count, row.node_count);
  fits &= narrow(entry.record_count - entry.node_count, row.repeated);
  for (int level = 0; level < 4; ++level)
    fits &= narrow(entry.place.next[level] - block.next[level], row.next[level]);
  return fits;
}

void ChunkDirectory::close_block() {
  if (open_.empty()) return;
  const ChunkEntry& first = open_.front().entry;
  Block block{first.offset, {}, first.first_subtree, kPacked};
  std::copy_n(first.place.next, 4, block.next);
  for (const Open& open : open_) {
    rows_.push_back({});
    if (!pack(block, open, rows_.back())) block.wide = static_cast<uint32_t>(wide_.size());
  }
  if (block.wide != kPacked)
    for (const Open& open : open_) {
      wide_.push_back(open.entry);
      wide_.back().hull = decode_bounds(open.hull);
      wide_.back().checksum = kept_checksum(open.entry.checksum);
    }
  blocks_.push_back(block);
  open_.clear();
}

ChunkEntry ChunkDirectory::operator[](size_t chunk) const {
  ChunkEntry entry = numbers(chunk);
  entry.hull = hull(chunk);
  entry.offset = offset(chunk);
  return entry;
}

ChunkEntry ChunkDirectory::numbers(size_t chunk) const {
  if (const ChunkEntry* entry = wide(chunk)) return *entry;
  const Block& block = blocks_[chunk / kBlockRows];
  const Row& row = rows_[chunk];
  ChunkEntry entry{};
  entry.checksum = row.checksum;
  entry.bytes = row.bytes * kUnit;
  entry.first_subtree = block.first_subtree + row.first_subtree;
  entry.subtree_count =
      (chunk + 1 < size() ? first_subtree(chunk + 1) : subtrees_) - entry.first_subtree;
  entry.node_count = row.node_count;
  entry.record_count = row.node_count + uint32_t{row.repeated};
  entry.place = place(chunk);
  return entry;
}

ChunkEntry ChunkDirectory::at(size_t chunk) const {
  if (chunk >= size())
    throw std::out_of_range("chunk " + std::to_string(chunk) + " of " + std::to_string(size()));
  return (*this)[chunk];
}

uint64_t ChunkDirectory::offset(size_t chunk) const {
  if (const ChunkEntry* entry = wide(chunk)) return entry->offset;
  uint64_t units = 0;
  for (size_t other = chunk / kBlockRows * kBlockRows; other < chunk; ++other)
    units += rows_[other].bytes;
  return blocks_[chunk / kBlockRows].offset + units * kUnit;
}

SubtreePlace ChunkDirectory::place(size_t chunk) const {
  if (const ChunkEntry* entry = wide(chunk)) return entry->place;
  const Block& block = blocks_[chunk / kBlockRows];
  const Row& row = rows_[chunk];
  SubtreePlace place{{}, row.listed_children, row.listed_grandchildren};
  for (int level = 0; level < 4; ++level) place.next[level] = block.next[level] + row.next[level];
  return place;
}

uint32_t ChunkDirectory::first_subtree(size_t chunk) const {
  if (const ChunkEntry* entry = wide(chunk)) return entry->first_subtree;
  return blocks_[chunk / kBlockRows].first_subtree + rows_[chunk].first_subtree;
}

uint32_t ChunkDirectory::bytes(size_t chunk) const {
  if (const ChunkEntry* entry = wide(chunk)) return entry->bytes;
  return rows_[chunk].bytes * kUnit;
}

}  // namespace voyager
