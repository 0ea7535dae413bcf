#pragma once
// Several inputs as one, block by block.
#include <functional>

#include "runtime/scene/import/block_reader.h"

namespace voyager {

// One of them, and what its header says.
struct BlockPart {
  uint64_t count = 0;
  int sh_degree = 0;
  NativeScale native;
  std::function<std::shared_ptr<BlockReader>()> open;
};

// One after the other: each is opened when its turn comes, and closed when its last block is
// decoded. A part may itself be merged. The lower SH degree is padded with zeros. Parts have the
// origin that is given. Throws Error(refused_input) where their counts add up to 2^64, or filters
// of the training differ.
std::unique_ptr<BlockReader> merge_blocks(std::string name, std::vector<BlockPart> parts,
                                          const std::array<double, 3>& origin);

}  // namespace voyager
