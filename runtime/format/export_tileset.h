#pragma once
// A tree as a tileset of 3D Tiles 1.1 (docs/formats.md, "A tileset").
#include <cstdint>
#include <functional>
#include <string>

#include "runtime/base/progress.h"
#include "runtime/format/reader.h"
#include "runtime/scene/export/flat_file.h"

namespace voyager {

struct TilesetOptions {
  uint64_t tile_bytes = 6'000'000;  // of the content of one tile, at most; one Gaussian at least
  FlatOptions flat;                 // of the .glb files
};

struct TilesetSummary {
  uint64_t tiles = 0;
  uint64_t leaves = 0;     // Gaussians of the scene
  uint64_t gaussians = 0;  // of all tiles
  uint64_t bytes = 0;      // of all files
  uint64_t largest = 0;    // bytes of a tile's content
  FlatContents contents;   // of the tiles, each from its own origin on
};

// Where the file of that name, in the tileset's folder, is to be written.
using PlaceFile = std::function<std::string(const std::string& name)>;

// Writes explicit tiles with refine REPLACE, each a .glb as write_flat_file() writes it, and
// tileset.json last. A tile's geometric error is kErrorOfExtent times the greatest extent that it
// shows in place of children. Memory: 24 bytes a node, and a tile. Throws Error(unsupported) for an
// empty scene, Error(damaged_chunk), Error(refused_input) where the tree does not fit together,
// and as write_flat_file() does. Progress stage "exporting".
TilesetSummary export_tileset(const SceneFile& scene, const PlaceFile& place,
                              const TilesetOptions& options = {}, const Progress& progress = {});

// A client refines where error · focal / distance is above its greatest screen-space error, 16
// pixels by default in Cesium; a cut where extent · focal / distance is 2τ + 1 or more. With this
// factor 16 pixels are τ = 3.
inline constexpr double kErrorOfExtent = 16.0 / 7.0;

}  // namespace voyager
