#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/format/chunk.h"
#include "runtime/format/chunk_directory.h"
#include "runtime/format/layout.h"
#include "runtime/lod/tree_rule.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

struct SceneFileInfo {
  Quality quality;
  int sh_degree, left_out_bands;
  NativeScale native;  // of a file of version 4 unknown, or compensated
  TreeKind tree;
  float blend_share;  // LodTree's
  bool kept_tree;     // a .hier's own (runtime/lod/kept_tree.h)
  uint32_t node_count;
  uint32_t leaf_count;
  uint32_t chunk_count;
  uint32_t depth;  // levels of the tree
  uint32_t subtree_count;
  uint32_t chunk_bytes;  // of records, at most
  uint32_t first_tier_levels;
  std::array<double, 3> origin;         // of the scene (METHOD §2)
  std::array<double, 3> source_origin;  // of the input's position words
  Vec3f bounds_min, bounds_max;         // the root's box, scene-local
  double position_error;                // compact: largest |error| of a mean, metres; lossless 0
  float largest_sh;                     // |coefficient|, over all bands of all nodes as read
  bool leaves_have_extent;              // some leaf's record has an extent that is not 0
  uint64_t further_offset;  // of the section of further Gaussians (further.h); 0: there is none
  ImportReport import;
};

// A .voy file. The header, the tiers and the chunk directory are checked at
// open (magic, version, lengths, XXH3, ranges), and some chunks of a large one
// (check_claims.h); a chunk when it is read.
class SceneFile {
 public:
  // Throws Error(refused_input) with file, offset, found, expected.
  explicit SceneFile(std::shared_ptr<const ByteSource> source);
  ~SceneFile();

  const SceneFileInfo& info() const { return info_; }
  const std::string& name() const { return source_->name(); }
  const ByteSource& source() const { return *source_; }

  const ChunkDirectory& chunks() const { return chunks_; }
  // Valid as long as the file.
  Tiers tiers() const;
  // The nodes that a chunk owns, ascending and disjoint; reads nothing.
  std::vector<NodeRange> nodes_of(uint32_t index) const;

  // Reads, checks and decodes one chunk. Throws Error(damaged_chunk) naming
  // file, chunk, offset, found, expected. Thread-safe.
  Chunk read_chunk(uint32_t index) const;

  // The stored bytes of consecutive chunks, in one read. Throws as the source does. Thread-safe.
  std::vector<std::byte> read_stored(uint32_t first, uint32_t last) const;
  // Checks and decodes one chunk from its stored bytes, as read_chunk() does. Thread-safe.
  Chunk decode(uint32_t index, std::span<const std::byte> stored) const;

  static bool is_scene_file(std::span<const std::byte> first_bytes);

 private:
  SubtreePlace place_after(uint32_t index) const;

  std::shared_ptr<const ByteSource> source_;
  SceneFileInfo info_{};
  uint32_t version_ = kSceneVersion;
  std::vector<uint32_t> level_begin_, tier_begin_;
  ChunkDirectory chunks_;
};

}  // namespace voyager
