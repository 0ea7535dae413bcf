#pragma once
// The hulls of a streamed scene's chunks, as searches read them.
#include <cstdint>

#include "runtime/format/reader.h"
#include "runtime/select/search_tree.h"

namespace voyager {

SearchChunk search_chunk(const SceneFile& file, uint32_t chunk);

}  // namespace voyager
