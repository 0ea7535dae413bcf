#pragma once
// How many tiles a thread block of bin counts at a time.
#include <cstddef>
#include <cstdint>

namespace voyager::cuda {

// Of a block's shared memory, for what it needs beside a count a tile.
inline constexpr size_t kBinScratchBytes = 2048;

// Thread blocks of bin that a multiprocessor is to hold: all that one of Orin does.
inline constexpr unsigned kBinBlocks = 2;

struct BinBands {
  uint32_t bands, tiles;  // of a band
};

// An eye's tiles in as few bands as a block's shared memory allows: for each the strips are read
// anew. The memory holds a count a tile: 20,224 on Orin, where an eye of 2064x2208 pixels has
// 17,802.
constexpr BinBands bin_bands(uint32_t tiles, size_t shared_bytes) {
  const auto most = static_cast<uint32_t>((shared_bytes - kBinScratchBytes) / sizeof(uint32_t));
  const uint32_t bands = (tiles + most - 1) / most;
  return {bands, (tiles + bands - 1) / bands};
}

}  // namespace voyager::cuda
