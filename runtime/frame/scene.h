#pragma once
// A scene as backends draw it: activated Gaussians, and the tree if it has one.
#include <array>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <string>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/base/workers.h"
#include "runtime/frame/scene_profile.h"
#include "runtime/math/gaussian.h"
#include "runtime/math/large_families.h"
#include "runtime/math/mean_code.h"
#include "runtime/math/run_index.h"
#include "runtime/math/sh_code.h"
#include "runtime/math/shape_code.h"
#include "runtime/scene/gaussian_cloud.h"
#include "runtime/scene/native_scale.h"
#include "runtime/select/search_tree.h"
#include "runtime/stream/scene_stream.h"

namespace voyager {

enum class Storage { flat, lossless, compact };

// What a scene reports about itself: left out, mended, dropped, damaged.
struct SceneNote {
  enum class Kind { omitted, repaired, dropped, damaged } kind;
  uint64_t count;
  uint64_t bytes;
  std::string what, why;
  uint32_t splat_bytes = 0;  // omitted: that a device would read more for each splat, at least
};

// A chunk that could not be read. Its subtrees are in the partition as kLostSubtree,
// so that the indices of all others hold.
struct DamagedChunk {
  uint32_t chunk;
  uint32_t first_subtree, subtree_count;
  uint32_t first_root;  // of the first subtree
  bool repeats_root;    // which the chunk before has, too
  std::string message;  // names file, chunk, offset, found, expected
};

// One node, of no id: nothing that a search may follow.
inline constexpr Subtree kLostSubtree{kNoNode, 0, 0, 1, 0, 0, Repeats::nothing};

// Nodes whose chunk could not be read: [first, first + count). A chunk has up to three
// such ranges a tier.
struct DamagedNodes {
  uint32_t first, count;
  std::string message;  // names file, chunk, offset, found, expected
};

// Of a scene that is streamed only the chunks in `pool` are there. Where they lie on the host,
// what is said to be by node id is by address (slot * SlotShape::nodes + place in the chunk),
// and may be read under stream->hold(); where they do not, those arrays are empty.
struct Scene {
  explicit Scene(std::pmr::memory_resource* memory)
      : gaussians(memory),
        sh(memory),
        node_code(memory),
        mean_codes(memory),
        shapes(memory),
        sh_rows(memory),
        sh_scales(memory),
        mean_grids(memory),
        group_blocks(memory),
        tree(memory),
        child_count(memory),
        large_families(memory),
        search(memory),
        leaves(memory),
        partition(memory),
        slot_ids(memory),
        root_parents(memory) {}

  bool flat() const { return storage == Storage::flat; }
  bool streamed() const { return stream != nullptr; }
  int coefficients() const { return sh_coefficients(sh_degree); }

  std::string name;
  Storage storage = Storage::flat;
  int sh_degree = 0;     // of what is kept: SceneProfile has the input's
  NativeScale native;    // what it is drawn with where the view antialiases
  bool doubles = false;  // nodes of one child are doubles, as files of version 4 have them
  uint32_t tree_depth = 0, chunk_count = 0;
  uint64_t leaf_count = 0, node_count = 0;         // of the whole tree
  Vec3d origin{0, 0, 0};                           // world position of the scene-local zero
  Vec3f bounds_min{0, 0, 0}, bounds_max{0, 0, 0};  // scene-local, means ± 3·max(s)
  double position_error = 0;
  float largest_sh = 0;  // of a baked scene: no coefficient of it is larger
  ImportReport import;
  SceneProfile profile;

  // By node id; a flat scene's by index. Of a compact scene as the file stores them, of the others
  // in binary32 (scene_gaussians.h): the arrays of the one or of the other are empty.
  std::pmr::vector<Gaussian> gaussians;
  std::pmr::vector<float> sh;           // coefficients() * 3 each
  std::pmr::vector<uint8_t> node_code;  // of a lossless tree (runtime/math/node_code.h)
  std::pmr::vector<MeanCode> mean_codes;
  std::pmr::vector<ShapeCode> shapes;
  std::pmr::vector<uint8_t> sh_rows;        // sh_row_bytes() each
  std::pmr::vector<ShScales> sh_scales;     // by group
  std::pmr::vector<MeanGrid> mean_grids;    // the same
  std::pmr::vector<RunBlock> group_blocks;  // empty where a slot is a group
  uint32_t slot_nodes = 0;                  // of a pool on the host
  // Empty for a flat scene. Its records and first_child may be left out: whole_tree() makes them
  // (whole_tree.h), and node_links() says how many children a node has (node_links.h).
  LodTree tree;
  std::pmr::vector<uint32_t> child_count;        // by node id, of a lossless tree without records
  std::pmr::vector<LargeFamily> large_families;  // of a compact scene
  SearchTree search;                             // of the tree; empty for a flat scene
  std::pmr::vector<uint32_t> leaves;  // node ids of the leaves in the input's order; flat: empty
  Partition partition;                // of the tree; empty for a flat scene
  std::vector<DamagedNodes> damaged;  // by first, disjoint
  std::vector<DamagedChunk> damaged_chunks;  // by chunk
  std::vector<SceneNote> notes;

  // Of a streamed scene on the host, which has no tree.parent.
  std::pmr::vector<SlotIds> slot_ids;
  std::pmr::vector<uint32_t> root_parents;  // by a subtree's place: what its roots hang from
  std::unique_ptr<ChunkPool> pool;
  std::unique_ptr<SceneStream> stream;  // fills the pool, so goes before it
};

// METHOD §12: its nodes' codes say which each has. A flat scene has one.
inline bool footprints_differ(const Scene& scene) {
  return !scene.flat() && scene.native.levels > 1;
}

// Told by the first bytes, of some formats by the name: a baked .voy, or a flat scene. Throws
// Error(refused_input) for anything else.
enum class SceneFormat { baked, flat };
SceneFormat scene_format(const ByteSource& source);

// Opens a .voy, or whatever import_gaussians() reads. Throws Error; std::bad_alloc
// where `memory` refuses.
std::shared_ptr<Scene> load_scene(const std::shared_ptr<const ByteSource>& source,
                                  std::pmr::memory_resource* memory, Workers& workers);

}  // namespace voyager
