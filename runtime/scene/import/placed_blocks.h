#pragma once
// An input that is moved, turned, scaled or mirrored, block by block.
#include "runtime/math/affine.h"
#include "runtime/scene/import/block_reader.h"

namespace voyager {

// In INRIA axes. Blocks have the origin. Throws as CloudTransform does, naming `what`.
std::unique_ptr<BlockReader> place_blocks(std::unique_ptr<BlockReader> reader, const Affine& place,
                                          const std::array<double, 3>& origin,
                                          const std::string& what);

}  // namespace voyager
