#pragma once
// PlayCanvas's .compressed.ply: a .ply of packed words. The bounds of each 256 Gaussians are an
// element "chunk", before the vertices; SH bands above the constant are an element "sh" after them.
#include <memory>

#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/ply_elements.h"

namespace voyager::ply {

// Has it packed words, or bounds for such?
bool is_compressed(const Header& header);

// `input` stands at the first element. `again` is the same file from its start on, or null: then
// the packed words of all Gaussians, 16 bytes each, are held until their SH bands have come.
std::unique_ptr<BlockReader> open_compressed(std::unique_ptr<Input> input,
                                             std::unique_ptr<ByteReader> again);

}  // namespace voyager::ply
