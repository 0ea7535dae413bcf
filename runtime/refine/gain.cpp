#include "runtime/refine/gain.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "runtime/lod/shape.h"

namespace voyager {
namespace {

constexpr size_t kSplatsBlock = 256;
// Tiles add up what they find as integers, so that their order does not show.
constexpr double kUnit = 0x1p-24, kMost = 0x1p29;
constexpr float kLeastBehind = 1e-3f;  // transmittance from which on what is behind can be told

// The splats of a node's children, front to back.
struct Family {
  Splat children[kChildren];
  uint32_t count = 0;  // that reach the picture
  bool merged = false;

  void add(const Splat& splat) {
    uint32_t at = count++;
    for (; at > 0 && splat.depth < children[at - 1].depth; --at) children[at] = children[at - 1];
    children[at] = splat;
  }
};

Family family_of(const ProjectParams& params, const NodeArrays& arrays, const LodTree& tree,
                 uint32_t node) {
  Family family;
  family.merged = !tree.is_leaf(node);
  for (uint32_t i = 0; i < tree.records[node].child_count; ++i)
    if (const auto splat = splat_of(params, arrays, tree.first_child[node] + i)) family.add(*splat);
  return family;
}

// What is drawn in one pixel by one node, or by its children.
struct Layer {
  Vec3f colour{0, 0, 0};
  float transmittance = 1;

  void add(const Splat& splat, const PixelCentre& at) {
    const float alpha = alpha_at(splat, at);
    colour = colour + (transmittance * alpha) * splat.colour;
    transmittance -= transmittance * alpha;
  }
};

// One pixel of a cut's picture while its splats are blended once more.
struct Pixel {
  Vec3f drawn, error;  // the cut's picture, and what it differs by
  Vec3f so_far{0, 0, 0};
  float transmittance = 1;
};

// By how much the squared error falls where `children` take the place of `own`.
double gain_of(const Pixel& pixel, const Layer& own, const Layer& children) {
  const float t = pixel.transmittance, behind = t * own.transmittance;
  const Vec3f with_own = pixel.so_far + t * own.colour;
  // The colour behind this node, from the finished picture; black if too little of it shows.
  const Vec3f back = behind > kLeastBehind ? (1 / behind) * (pixel.drawn - with_own) : Vec3f{};
  const Vec3f change =
      t * ((children.colour - own.colour) + (children.transmittance - own.transmittance) * back);
  return -(2.0 * double{dot(pixel.error, change)} + double{dot(change, change)});
}

class Tile {
 public:
  Tile(int tile, const Picture& cut, const Picture& leaves) : tile_(tile) {
    for (int i = 0; i < kTilePixels; ++i) {
      pixels_[i].drawn = cut.colours(tile)[i];
      pixels_[i].error = cut.colours(tile)[i] - leaves.colours(tile)[i];
      if (!pixel_centre(tile, i).inside()) pixels_[i].transmittance = 0;
    }
  }

  // Blends a node, and tells what its children in its place would gain.
  double blend(const Splat& splat, const Family& family) {
    double sum = 0;
    for (int i = 0; i < kTilePixels; ++i) {
      Pixel& pixel = pixels_[i];
      if (pixel.transmittance < kTransmittanceEnd) continue;
      const PixelCentre at = pixel_centre(tile_, i);
      Layer own, children;
      own.add(splat, at);
      if (pixel.transmittance * own.transmittance < kTransmittanceEnd) {
        pixel.transmittance = 0;  // as a picture ends
        continue;
      }
      for (uint32_t k = 0; k < family.count; ++k) children.add(family.children[k], at);
      if (family.merged) sum += gain_of(pixel, own, children);
      pixel.so_far = pixel.so_far + pixel.transmittance * own.colour;
      pixel.transmittance *= own.transmittance;
    }
    return sum;
  }

 private:
  int tile_;
  Pixel pixels_[kTilePixels];
};

}  // namespace

std::vector<NodeGain> gains(const ProjectParams& params, const NodeArrays& arrays,
                            const LodTree& tree, const Picture& cut, const Picture& leaves,
                            Workers& workers) {
  const auto& splats = cut.splats();
  std::vector<Family> families(splats.size());
  workers.for_blocks(splats.size(), kSplatsBlock, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      families[i] = family_of(params, arrays, tree, splats[i].node);
  });
  std::vector<TileRange> ranges;
  for (size_t i = 0; i < splats.size(); ++i) {
    ranges.push_back(tiles_of(splats[i].splat));
    for (uint32_t k = 0; k < families[i].count; ++k)
      ranges[i].cover(tiles_of(families[i].children[k]));
  }
  const TileLists lists = tile_lists(ranges);
  std::vector<std::atomic<int64_t>> sums(splats.size());
  workers.for_blocks(kTiles, 1, [&](size_t at, size_t) {
    const auto index = static_cast<int>(at);
    Tile tile(index, cut, leaves);
    for (const uint32_t i : lists[at]) {
      const double sum = tile.blend(splats[i].splat, families[i]);
      // NaN, where colours are beyond binary32, is no gain.
      if (std::fabs(sum) > 0)
        sums[i].fetch_add(std::llround(std::clamp(sum, -kMost, kMost) / kUnit),
                          std::memory_order_relaxed);
    }
  });
  std::vector<NodeGain> found;
  for (size_t i = 0; i < splats.size(); ++i)
    if (families[i].merged)
      found.push_back({splats[i].node, kUnit * static_cast<double>(sums[i].load())});
  std::sort(found.begin(), found.end(),
            [](const NodeGain& a, const NodeGain& b) { return a.node < b.node; });
  return found;
}

}  // namespace voyager
