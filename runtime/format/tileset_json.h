#pragma once
// The tileset.json of explicit tiles.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "runtime/math/vec.h"

namespace voyager {

// INRIA's axes, metres. Empty as it is made.
struct TileBox {
  Vec3d least{INFINITY, INFINITY, INFINITY}, most{-INFINITY, -INFINITY, -INFINITY};

  void add(const TileBox& other) {
    for (int axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], other.least[axis]);
      most[axis] = std::max(most[axis], other.most[axis]);
    }
  }
};

struct TileEntry {
  std::string uri;      // of its content
  double error = 0;     // geometric
  TileBox own, volume;  // of the content; of the content and all children
  std::vector<size_t> children;
};

// The first tile is the root. `origin`: where the tiles are, INRIA's axes. Tiles have z up, and
// their glTF files y: x, y, z become -x, -z, -y.
std::string tileset_json(const std::vector<TileEntry>& tiles, const std::array<double, 3>& origin,
                         bool spz_inside);

}  // namespace voyager
