#pragma once
// The Gaussians of a primitive's accessors, block by block.
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/gltf/primitive.h"

namespace voyager::gltf {

// A primitive without SPZ. `name`: the file's.
std::unique_ptr<BlockReader> read_accessors(std::string name, Primitive primitive);

}  // namespace voyager::gltf
