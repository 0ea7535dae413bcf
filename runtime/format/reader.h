#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/format/chunk.h"
#include "runtime/format/layout.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

struct SceneFileInfo {
  Quality quality;
  int sh_degree;
  bool antialiased;
  uint32_t node_count;
  uint32_t leaf_count;
  uint32_t chunk_count;
  uint32_t depth;                       // levels of the tree
  std::array<double, 3> origin;         // of the scene (METHOD §2)
  std::array<double, 3> source_origin;  // of the input's position words
  Vec3f bounds_min, bounds_max;         // the root's box, scene-local
  double position_error;                // compact: largest |error| of a mean, metres; lossless 0
  ImportReport import;
};

// A .voy file. The header, section table and chunk directory are checked at
// open (magic, version, lengths, XXH3, ranges); a chunk when it is read.
class SceneFile {
 public:
  // Throws Error(refused_input) with file, offset, found, expected.
  explicit SceneFile(std::shared_ptr<const ByteSource> source);
  ~SceneFile();

  const SceneFileInfo& info() const { return info_; }
  const std::string& name() const { return source_->name(); }

  struct ChunkExtent {
    uint64_t offset;  // in the file
    uint32_t bytes;   // stored
    uint32_t first_node, node_count;
    uint32_t first_child;  // id of the first child of the chunk's first interior node
    uint64_t checksum;
  };
  const std::vector<ChunkExtent>& chunks() const { return chunks_; }

  // Reads, checks and decodes one chunk. Throws Error(damaged_chunk) naming
  // file, chunk, offset, found, expected. Thread-safe.
  Chunk read_chunk(uint32_t index) const;

  static bool is_scene_file(std::span<const std::byte> first_bytes);

 private:
  std::shared_ptr<const ByteSource> source_;
  SceneFileInfo info_{};
  std::vector<ChunkExtent> chunks_;
};

}  // namespace voyager
