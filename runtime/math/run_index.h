#pragma once
// Which run an item is of, where runs are of consecutive items: half a byte an item.
#include <cstdint>
#include <span>

#include "runtime/math/count_bits.h"
#include "runtime/math/host_device.h"

namespace voyager {

// Of 32 items.
struct RunBlock {
  uint32_t first;   // the run of the first of them
  uint32_t starts;  // a bit for each of the others that begins the next run
};

VOYAGER_HD uint32_t run_of(const RunBlock* blocks, uint32_t item) {
  const RunBlock block = blocks[item / 32];
  const uint32_t up_to = (2u << item % 32) - 1u;
  return block.first + count_bits(block.starts & up_to);
}

// starts: a bit for every item that begins a run; that of the first does not matter. Returns how
// many runs there are.
inline uint32_t number_runs(std::span<RunBlock> blocks) {
  uint32_t run = 0;
  for (size_t i = 0; i < blocks.size(); ++i) {
    RunBlock& block = blocks[i];
    // That a block's first begins a run is told by its number.
    if (i != 0) run += block.starts & 1u;
    block.starts &= ~1u;
    block.first = run;
    run += count_bits(block.starts);
  }
  return run + 1;
}

}  // namespace voyager
