#include "runtime/stream/chunk_ranges.h"

#include <algorithm>
#include <limits>

namespace voyager {

void ChunkRanges::add(ChunkRange range) {
  open_.push_back(range);
  if (open_.size() == kBlockRows) close_block();
}

void ChunkRanges::close() {
  close_block();
  open_ = {};
  rows_.shrink_to_fit();
  blocks_.shrink_to_fit();
  wide_.shrink_to_fit();
}

void ChunkRanges::close_block() {
  if (open_.empty()) return;
  constexpr uint32_t kMost = std::numeric_limits<uint16_t>::max();
  uint32_t least = kPacked;
  for (const ChunkRange& range : open_)
    if (!range.empty()) least = std::min(least, range.first);
  Block block{least, kPacked};
  for (const ChunkRange& range : open_) {
    const uint32_t first = range.empty() ? 0 : range.first - least,
                   count = range.last - range.first;
    if (first > kMost || count > kMost) block.wide = static_cast<uint32_t>(wide_.size());
    rows_.push_back({static_cast<uint16_t>(std::min(first, kMost)),
                     static_cast<uint16_t>(std::min(count, kMost))});
  }
  if (block.wide != kPacked) wide_.insert(wide_.end(), open_.begin(), open_.end());
  blocks_.push_back(block);
  open_.clear();
}

}  // namespace voyager
