#pragma once
// The tileset.json of 3D Tiles 1.0 and 1.1, whose tiles are glTF files with splats: the finest
// level, all at once.
#include <nlohmann/json.hpp>

#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/left_out.h"

namespace voyager::tileset {

// A glTF has no root.
bool is_tileset(const nlohmann::json& json);

// The contents of the tiles without children, and of those that their children add to. Tiles of
// other tilesets belong to it. Each file is opened for its header now, and again when its turn
// comes; tiles that name one file follow the first that does. A file of a tile lies in the
// tileset's folder or below. Throws Error(refused_input) naming file and place: implicit tiles,
// contents of other types, extensions that are required, a tileset that is referred to twice, more
// than kMostDepth tilesets in one another, and more Gaussians than the files are worth; else what
// opening the files throws.
std::unique_ptr<BlockReader> open(std::shared_ptr<const ByteSource> source, nlohmann::json json);

// What of the .spz in its files is not read. Opens each file as open() does, and throws as it.
LeftOut left_out(std::shared_ptr<const ByteSource> source, nlohmann::json json);

inline constexpr int kMostDepth = 16;

}  // namespace voyager::tileset
