#pragma once
// A picture of some nodes of a baked scene, each drawn as itself (METHOD §5–7, but for rounding),
// and its splats, for those that ask more of it.
#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "runtime/refine/node_arrays.h"
#include "runtime/refine/viewpoint.h"
#include "runtime/stages/project.h"

namespace voyager {

struct NodeSplat {
  Splat splat;
  uint32_t node;
};

// Square, of pixels; the last of a row or column reach beyond the picture.
inline constexpr int kPictureTile = 16;
inline constexpr int kTilePixels = kPictureTile * kPictureTile;
inline constexpr int kTileColumns = (kPictureWidth + kPictureTile - 1) / kPictureTile;
inline constexpr int kTileRows = (kPictureHeight + kPictureTile - 1) / kPictureTile;
inline constexpr int kTiles = kTileColumns * kTileRows;

using TileColours = Vec3f[kTilePixels];

// Tiles, both ends included.
struct TileRange {
  int left, right, top, bottom;

  void cover(const TileRange& other) {
    left = std::min(left, other.left), right = std::max(right, other.right);
    top = std::min(top, other.top), bottom = std::max(bottom, other.bottom);
  }
};
// Those that a splat's box touches; the nearest where it touches none.
TileRange tiles_of(const Splat& splat);

// For each tile indices into `ranges` of those that hold it, ascending.
using TileLists = std::vector<std::vector<uint32_t>>;
TileLists tile_lists(std::span<const TileRange> ranges);

// native: of the scene, known.
ProjectParams picture_params(const Viewpoint& view, const NativeScale& native);

// Nothing where it does not reach the picture.
std::optional<Splat> splat_of(const ProjectParams& params, const NodeArrays& arrays, uint32_t node);

struct PixelCentre {
  float x, y;

  bool inside() const {
    return x < static_cast<float>(kPictureWidth) && y < static_cast<float>(kPictureHeight);
  }
};
// Of a tile's pixel, row by row.
inline PixelCentre pixel_centre(int tile, int pixel) {
  const int column = tile % kTileColumns * kPictureTile + pixel % kPictureTile;
  const int row = tile / kTileColumns * kPictureTile + pixel / kPictureTile;
  return {static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f};
}

// α at a pixel's centre, 0 outside the support.
inline float alpha_at(const Splat& s, const PixelCentre& at) {
  const float dx = at.x - s.x, dy = at.y - s.y;
  const float p = dx * s.conic.p_x, q = (dy - s.conic.skew * dx) * s.conic.q_y;
  const float rho = -(p * p + q * q);
  if (!(rho >= s.rho_min)) return 0;
  return std::fmin(kAlphaMax, exp_negative(std::fmin(s.log_opacity + rho, 0.0f)));
}

class Picture {
 public:
  Picture(const ProjectParams& params, const NodeArrays& arrays, std::span<const uint32_t> nodes,
          Workers& workers);

  const std::vector<NodeSplat>& splats() const { return splats_; }  // front to back
  const TileColours& colours(int tile) const { return colours_[static_cast<size_t>(tile)].of; }

 private:
  struct Colours {
    TileColours of;
  };
  void blend(int tile, std::span<const uint32_t> list);

  std::vector<NodeSplat> splats_;
  std::vector<Colours> colours_;
};

}  // namespace voyager
