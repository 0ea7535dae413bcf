#pragma once
// A SOG scene in blocks. Its images hold a pixel a Gaussian for each parameter; they are decoded
// one after the other before the first block, and what they say is kept as 19 bytes a Gaussian.
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/sog/image.h"
#include "runtime/scene/import/sog/meta.h"

namespace voyager::sog {

// The Gaussians that files of so many bytes are worth.
uint64_t most_gaussians_in(uint64_t file_bytes, bool has_sh);

// Reads the meta.json and the centroids of SH bands. `first` and `count` choose Gaussians; count
// may be more than there are. `budget`: as decode_webp(); outlives the reader.
std::unique_ptr<BlockReader> open_scene(std::unique_ptr<Files> files, uint64_t first = 0,
                                        uint64_t count = UINT64_MAX, PixelBudget* budget = nullptr);

// open_sog_blocks()
std::unique_ptr<BlockReader> open(std::shared_ptr<const ByteSource> source);

}  // namespace voyager::sog
