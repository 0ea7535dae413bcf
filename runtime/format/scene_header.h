#pragma once
// What stands before the chunks of a .voy, for a writer that has met all of them.
#include <vector>

#include "runtime/format/layout.h"
#include "runtime/lod/tree_rule.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

// The header's facts about a scene.
struct SceneTotals {
  Quality quality = Quality::lossless;
  int sh_degree = 0, left_out_bands = 0;
  TreeKind tree = TreeKind::clustered;
  float blend_share = kLateShare;
  bool kept_tree = false, further = false;  // the section of further Gaussians is there
  NativeScale native;
  uint32_t leaf_count = 0;
  uint32_t chunk_bytes = 0;
  Tiers tiers;
  std::array<double, 3> origin{0, 0, 0}, source_origin{0, 0, 0};
  Vec3f bounds_min{0, 0, 0}, bounds_max{0, 0, 0};
  ImportReport import;
  // Over all chunks.
  double position_error = 0;
  float largest_sh = 0;
  bool leaves_have_extent = false;
};

// Bytes of header, tiers and directory: where the first chunk starts.
uint64_t bytes_before_chunks(const Tiers& tiers, size_t chunks, Quality quality);

// The bytes before the chunks; file_length is of the whole.
std::vector<std::byte> encode_head(const SceneTotals& totals,
                                   const std::vector<ChunkEntry>& entries, uint64_t file_length);

}  // namespace voyager
