#include "runtime/cpu/bin.h"

#include <algorithm>
#include <numeric>

namespace voyager::cpu {
namespace {

// Calls visit(tile) for each tile of one splat, row by row.
template <class Visit>
void for_tiles(const Splat& splat, const TileGrid& grid, bool alpha_filter, uint32_t* boxed,
               const Visit& visit) {
  const TileRange rows = box_tiles(splat.y, splat.half_height, grid.rows);
  const TileRange box = box_tiles(splat.x, splat.half_width, grid.columns);
  *boxed = static_cast<uint32_t>((rows.end - rows.begin) * (box.end - box.begin));
  if (*boxed == 0) return;
  const bool whole = !alpha_filter || *boxed == 1;
  const SupportEllipse ellipse = whole ? SupportEllipse{} : support_ellipse(splat);
  for (int32_t row = rows.begin; row < rows.end; ++row) {
    const TileRange columns = whole ? box : strip_columns(ellipse, row, grid);
    for (int32_t column = columns.begin; column < columns.end; ++column)
      visit(static_cast<size_t>(row) * static_cast<size_t>(grid.columns) +
            static_cast<size_t>(column));
  }
}

// Few enough that the counters stay small, whatever the number of threads.
size_t splats_a_block(size_t splats, size_t tiles) {
  const size_t blocks = std::clamp<size_t>((size_t{16} << 20) / tiles, 1, 64);
  return std::max<size_t>((splats + blocks - 1) / blocks, 4096);
}

}  // namespace

void TileBins::build(const Splat* splats, std::span<const uint32_t> order, const TileGrid& grid,
                     bool alpha_filter, Workers& workers) {
  const size_t tiles = static_cast<size_t>(grid.columns) * static_cast<size_t>(grid.rows);
  const size_t grain = splats_a_block(order.size(), tiles);
  const size_t blocks = (order.size() + grain - 1) / grain;
  counts_.assign(blocks * tiles, 0);
  starts_.assign(tiles + 1, 0);
  std::vector<uint64_t> boxed(blocks, 0);

  workers.for_blocks(order.size(), grain, [&](size_t begin, size_t end) {
    uint32_t* counts = counts_.data() + begin / grain * tiles;
    uint64_t sum = 0;
    for (size_t i = begin; i < end; ++i) {
      uint32_t box = 0;
      for_tiles(splats[order[i]], grid, alpha_filter, &box, [&](size_t tile) { ++counts[tile]; });
      sum += box;
    }
    boxed[begin / grain] = sum;
  });

  for (size_t tile = 0; tile < tiles; ++tile) {
    uint32_t before = 0;  // in this tile, from earlier blocks
    for (size_t block = 0; block < blocks; ++block) {
      const uint32_t count = counts_[block * tiles + tile];
      counts_[block * tiles + tile] = before;
      before += count;
    }
    starts_[tile + 1] = starts_[tile] + before;
  }
  pairs_before_ = std::accumulate(boxed.begin(), boxed.end(), uint64_t{0});
  pairs_after_ = starts_[tiles];
  if (pairs_.size() < pairs_after_) pairs_.resize(pairs_after_);

  workers.for_blocks(order.size(), grain, [&](size_t begin, size_t end) {
    uint32_t* next = counts_.data() + begin / grain * tiles;
    for (size_t i = begin; i < end; ++i) {
      uint32_t box = 0;
      for_tiles(splats[order[i]], grid, alpha_filter, &box,
                [&](size_t tile) { pairs_[starts_[tile] + next[tile]++] = order[i]; });
    }
  });
}

}  // namespace voyager::cpu
