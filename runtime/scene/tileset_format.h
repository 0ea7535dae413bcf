#pragma once
// What the reader and the writer of tilesets agree on.
#include "runtime/math/vec.h"

namespace voyager::tileset {

// Tiles have z up, and their glTF files, with y up, are turned to it: (x, y, z) becomes
// (x, -z, y). Between z up and INRIA's axes, both ways, so that a tile that is not moved is its
// glTF file alone.
inline constexpr Mat3d kToInria{{{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}}};

}  // namespace voyager::tileset
