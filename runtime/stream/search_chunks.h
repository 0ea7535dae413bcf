#pragma once
// The hulls of a streamed scene's chunks, as searches read them.
#include <cstdint>
#include <span>

#include "runtime/format/reader.h"
#include "runtime/select/search_tree.h"

namespace voyager {

// Those of the chunks [first, first + out.size()); behind the last one is that with the end as its
// first subtree.
void set_search_chunks(const SceneFile& file, uint32_t first, std::span<SearchChunk> out);

}  // namespace voyager
