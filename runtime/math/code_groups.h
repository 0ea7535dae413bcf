#pragma once
// Which chunk's scales go with a Gaussian of a compact scene: Gaussians of one chunk are a group.
#include <cstdint>

#include "runtime/math/run_index.h"

namespace voyager {

// In the order of node ids a chunk's Gaussians come in several runs, each of which is a group; in a
// pool a slot is one.
struct CodeGroups {
  const RunBlock* blocks;  // by Gaussian / 32; null in a pool
  uint32_t slot_nodes;     // of a pool

  VOYAGER_HD uint32_t operator()(uint32_t gaussian) const {
    return blocks == nullptr ? gaussian / slot_nodes : run_of(blocks, gaussian);
  }
};

}  // namespace voyager
