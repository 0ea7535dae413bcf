#pragma once
// The finest level of a streamed SOG scene.
#include "runtime/scene/import/block_reader.h"

namespace voyager::sog {

// open_streamed_sog_blocks()
std::unique_ptr<BlockReader> open_streamed(std::shared_ptr<const ByteSource> source);

}  // namespace voyager::sog
