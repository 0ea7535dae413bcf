#include <algorithm>
#include <atomic>

#include "runtime/base/error.h"
#include "runtime/frame/load.h"

namespace voyager {
namespace {

[[noreturn]] void refuse(const Scene& scene, const std::string& found,
                         const std::string& expected) {
  throw Error(ErrorCode::refused_input, scene.name + ": found " + found + ", expected " + expected);
}

void set_info(const SceneFileInfo& info, Scene& scene) {
  scene.storage = info.quality == Quality::compact ? Storage::compact : Storage::lossless;
  scene.sh_degree = info.sh_degree;
  scene.antialiased = info.antialiased;
  scene.tree_depth = info.depth;
  scene.chunk_count = info.chunk_count;
  scene.leaf_count = info.leaf_count;
  scene.origin = {info.origin[0], info.origin[1], info.origin[2]};
  scene.bounds_min = info.bounds_min;
  scene.bounds_max = info.bounds_max;
  scene.position_error = info.position_error;
  scene.import = info.import;
}

void make_room(const SceneFileInfo& info, Scene& scene) {
  const size_t nodes = info.node_count;
  scene.gaussians.resize(nodes);
  scene.sh.resize(nodes * static_cast<size_t>(scene.coefficients()) * 3);
  scene.tree.records.resize(nodes);
  scene.tree.first_child.resize(nodes);
  scene.tree.parent.resize(nodes, kNoNode);
  scene.axis_code.resize(nodes);
  scene.leaves.resize(info.leaf_count, kNoNode);
}

// False if another node has claimed the same place in the input.
bool place_leaf(Scene& scene, uint32_t source_index, uint32_t node) {
  return std::atomic_ref<uint32_t>(scene.leaves[source_index])
             .exchange(node, std::memory_order_relaxed) == kNoNode;
}

// Chunks write apart from each other: a node has one chunk, and one parent.
bool store_chunk(const Chunk& chunk, Scene& scene) {
  bool leaves_once = true;
  uint32_t child = chunk.first_child;
  for (size_t i = 0; i < chunk.records.size(); ++i) {
    const auto node = static_cast<uint32_t>(chunk.first_node + i);
    const uint32_t children = chunk.records[i].child_count;
    scene.tree.records[node] = chunk.records[i];
    scene.axis_code[node] = chunk.axis_code[i];
    set_gaussian(scene, node, chunk.words[i], children == 0);
    if (children == 0) leaves_once &= place_leaf(scene, chunk.source_index[i], node);
    if (children == 0) continue;
    scene.tree.first_child[node] = child;
    std::fill_n(scene.tree.parent.begin() + child, children, node);
    child += children;
  }
  std::copy(chunk.sh.begin(), chunk.sh.end(),
            scene.sh.begin() +
                static_cast<std::ptrdiff_t>(size_t{chunk.first_node} *
                                            static_cast<size_t>(scene.coefficients()) * 3));
  return leaves_once;
}

// A Gaussian that draws nothing, should anything draw it.
void store_damaged(const SceneFile::ChunkExtent& extent, Scene& scene) {
  for (uint32_t i = 0; i < extent.node_count; ++i)
    set_gaussian(scene, extent.first_node + i, {{0, 0, 0}, {0, 0, 0}, {1, 0, 0, 0}, 0.0f}, false);
}

void read_chunks(const SceneFile& file, Workers& workers, Scene& scene) {
  std::vector<std::string> damage(file.chunks().size());
  std::atomic<bool> leaves_once{true};
  workers.for_blocks(file.chunks().size(), 1, [&](size_t index, size_t) {
    try {
      if (!store_chunk(file.read_chunk(static_cast<uint32_t>(index)), scene)) leaves_once = false;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::damaged_chunk) throw;
      damage[index] = error.what();
      store_damaged(file.chunks()[index], scene);
    }
  });
  if (!leaves_once) refuse(scene, "two leaves with one source index", "each once");
  for (size_t index = 0; index < damage.size(); ++index) {
    if (damage[index].empty()) continue;
    const SceneFile::ChunkExtent& extent = file.chunks()[index];
    scene.damaged.push_back({extent.first_node, extent.node_count, damage[index]});
    scene.notes.push_back({SceneNote::Kind::damaged, extent.node_count, extent.bytes,
                           "nodes of a chunk", damage[index]});
  }
}

bool inside(const NodeRecord& child, const NodeRecord& parent) {
  for (int axis = 0; axis < 3; ++axis)
    if (child.box_min[axis] < parent.box_min[axis] || child.box_max[axis] > parent.box_max[axis])
      return false;
  return child.extent <= parent.extent;
}

// damaged is by first, and its ranges do not overlap.
bool is_damaged(const Scene& scene, uint32_t node) {
  const auto after =
      std::upper_bound(scene.damaged.begin(), scene.damaged.end(), node,
                       [](uint32_t n, const DamagedNodes& range) { return n < range.first; });
  return after != scene.damaged.begin() && node - std::prev(after)->first < std::prev(after)->count;
}

// The cut meets every path once only if sizes never grow downwards: a file
// whose checksums are right and whose tree is not would break the search.
void check_nesting(const Scene& scene, Workers& workers) {
  const LodTree& tree = scene.tree;
  std::atomic<uint32_t> first_wrong{kNoNode};
  workers.for_blocks(tree.size(), 8192, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) {
      const uint32_t parent = tree.parent[n];
      if (parent == kNoNode || inside(tree.records[n], tree.records[parent])) continue;
      const auto node = static_cast<uint32_t>(n);
      if (is_damaged(scene, node)) continue;
      uint32_t least = first_wrong.load();
      while (node < least && !first_wrong.compare_exchange_weak(least, node)) {
      }
      return;
    }
  });
  if (first_wrong != kNoNode)
    refuse(scene,
           "node " + std::to_string(first_wrong) +
               " with a larger extent than its parent's or outside its box",
           "nested boxes, extents that never grow downwards");
}

// The last node of a breadth-first order is one of the deepest.
uint32_t depth_of(const LodTree& tree) {
  uint32_t depth = 0;
  for (uint32_t node = static_cast<uint32_t>(tree.size()) - 1; node != kNoNode;
       node = tree.parent[node])
    ++depth;
  return depth;
}

// What only the whole file can show.
void check_totals(const Scene& scene) {
  if (std::count(scene.leaves.begin(), scene.leaves.end(), kNoNode) != 0)
    refuse(scene, "an input Gaussian without a leaf", "one leaf each");
  const auto leaves =
      static_cast<uint64_t>(std::count_if(scene.tree.records.begin(), scene.tree.records.end(),
                                          [](const NodeRecord& r) { return r.child_count == 0; }));
  if (leaves != scene.leaf_count)
    refuse(scene, std::to_string(leaves) + " leaves", std::to_string(scene.leaf_count));
  const uint32_t depth = depth_of(scene.tree);
  if (depth != scene.tree_depth)
    refuse(scene, "a tree of " + std::to_string(depth) + " levels",
           std::to_string(scene.tree_depth));
  const NodeRecord& root = scene.tree.records[0];
  for (int axis = 0; axis < 3; ++axis)
    if (root.box_min[axis] != scene.bounds_min[axis] ||
        root.box_max[axis] != scene.bounds_max[axis])
      refuse(scene, "bounds that are not the root's box", "the same");
}

}  // namespace

void load_baked(const SceneFile& file, Workers& workers, Scene& scene) {
  set_info(file.info(), scene);
  make_room(file.info(), scene);
  read_chunks(file, workers, scene);
  check_nesting(scene, workers);
  if (scene.damaged.empty() && scene.tree.size() != 0) check_totals(scene);
  add_notes(scene);
}

}  // namespace voyager
