#include "runtime/refine/picture.h"

#include <algorithm>
#include <cmath>

namespace voyager {
namespace {

constexpr size_t kNodesBlock = 4096;
constexpr float kNear = 0.2f;

int tile_at(float along, int tiles) {
  return static_cast<int>(std::clamp(along / kPictureTile, 0.0f, static_cast<float>(tiles - 1)));
}

}  // namespace

ProjectParams picture_params(const Viewpoint& view, const NativeScale& native) {
  ProjectParams params;
  params.origin = {0, 0, 0};
  params.eye = view.eye;
  params.view =
      view_projection<float>(view.world_to_view, kPictureFocal, kPictureFocal, 0.5 * kPictureWidth,
                             0.5 * kPictureHeight, kPictureWidth, kPictureHeight);
  params.near_z = kNear;
  params.depth_scale = 1;
  params.width = static_cast<float>(kPictureWidth);
  params.height = static_cast<float>(kPictureHeight);
  params.filter = {static_cast<float>(native.low_pass), static_cast<float>(native.footprint()),
                   true};
  params.half = 0.5f;
  params.log_scale = 1;
  params.log_threshold = kLogAlphaThreshold;
  params.opacity = 1;
  params.log_opacity = 0;
  params.clip = local_clip(kNoClip, params.origin);
  return params;
}

std::optional<Splat> splat_of(const ProjectParams& params, const NodeArrays& arrays,
                              uint32_t node) {
  const DrawItem item{node, kNoNode, 1.0f, 1.0f};
  DrawnGaussian drawn;
  Splat splat;
  if (!read_gaussian(params, arrays, item, drawn) || !project(params, arrays, item, drawn, splat))
    return std::nullopt;
  return splat;
}

TileRange tiles_of(const Splat& s) {
  return {tile_at(s.x - s.half_width, kTileColumns), tile_at(s.x + s.half_width, kTileColumns),
          tile_at(s.y - s.half_height, kTileRows), tile_at(s.y + s.half_height, kTileRows)};
}

TileLists tile_lists(std::span<const TileRange> ranges) {
  TileLists lists(kTiles);
  for (uint32_t i = 0; i < ranges.size(); ++i)
    for (int row = ranges[i].top; row <= ranges[i].bottom; ++row)
      for (int column = ranges[i].left; column <= ranges[i].right; ++column)
        lists[static_cast<size_t>(row) * kTileColumns + static_cast<size_t>(column)].push_back(i);
  return lists;
}

Picture::Picture(const ProjectParams& params, const NodeArrays& arrays,
                 std::span<const uint32_t> nodes, Workers& workers)
    : colours_(kTiles) {
  std::vector<std::vector<NodeSplat>> found((nodes.size() + kNodesBlock - 1) / kNodesBlock);
  workers.for_blocks(nodes.size(), kNodesBlock, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      if (const auto splat = splat_of(params, arrays, nodes[i]))
        found[begin / kNodesBlock].push_back({*splat, nodes[i]});
  });
  for (const auto& block : found) splats_.insert(splats_.end(), block.begin(), block.end());
  workers.sort(splats_.begin(), splats_.end(), [](const NodeSplat& a, const NodeSplat& b) {
    return a.splat.depth != b.splat.depth ? a.splat.depth < b.splat.depth : a.node < b.node;
  });
  std::vector<TileRange> ranges;
  for (const NodeSplat& s : splats_) ranges.push_back(tiles_of(s.splat));
  const TileLists lists = tile_lists(ranges);
  workers.for_blocks(kTiles, 1,
                     [&](size_t tile, size_t) { blend(static_cast<int>(tile), lists[tile]); });
}

void Picture::blend(int tile, std::span<const uint32_t> list) {
  Vec3f* colours = colours_[static_cast<size_t>(tile)].of;
  float transmittance[kTilePixels];
  std::fill_n(colours, kTilePixels, Vec3f{0, 0, 0});
  std::fill_n(transmittance, kTilePixels, 1.0f);
  for (const uint32_t i : list) {
    const Splat& s = splats_[i].splat;
    for (int pixel = 0; pixel < kTilePixels; ++pixel) {
      float& t = transmittance[pixel];
      if (t < kTransmittanceEnd) continue;
      const float alpha = alpha_at(s, pixel_centre(tile, pixel));
      const float after = t - alpha * t;
      if (after >= kTransmittanceEnd) colours[pixel] = colours[pixel] + (t * alpha) * s.colour;
      t = after;
    }
  }
}

}  // namespace voyager
