#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "runtime/base/error.h"
#include "runtime/frame/code_groups.h"
#include "runtime/frame/load.h"
#include "runtime/frame/scene_gaussians.h"
#include "runtime/frame/whole_tree.h"
#include "runtime/lod/nesting.h"
#include "runtime/lod/round_bounds.h"
#include "runtime/scene/sh_bands.h"

namespace voyager {
namespace {

[[noreturn]] void refuse(const Scene& scene, const std::string& found,
                         const std::string& expected) {
  throw Error(ErrorCode::refused_input, scene.name + ": found " + found + ", expected " + expected);
}

}  // namespace

void set_info(const SceneFileInfo& info, Scene& scene) {
  if (info.subtree_count >= kLowest)
    throw Error(ErrorCode::unsupported, scene.name + ": found " +
                                            std::to_string(info.subtree_count) +
                                            " subtrees, expected fewer than 2^31");
  scene.storage = info.quality == Quality::compact ? Storage::compact : Storage::lossless;
  scene.sh_degree = info.sh_degree;
  scene.profile.input_sh_degree = info.sh_degree + info.left_out_bands;
  scene.profile.merged = info.node_count > info.leaf_count;
  scene.profile.interpolated = info.node_count > 1;
  scene.native = info.native;
  scene.doubles = extent_rule(info.tree, info.blend_share) == ExtentRule::error_with_doubles;
  scene.tree.blend_share = info.blend_share;
  scene.tree_depth = info.depth;
  scene.chunk_count = info.chunk_count;
  scene.leaf_count = info.leaf_count;
  scene.node_count = info.node_count;
  scene.origin = {info.origin[0], info.origin[1], info.origin[2]};
  scene.bounds_min = info.bounds_min;
  scene.bounds_max = info.bounds_max;
  scene.position_error = info.position_error;
  scene.largest_sh = info.largest_sh;
  scene.import = info.import;
}

namespace {

void make_room(const SceneFileInfo& info, Scene& scene) {
  const size_t nodes = info.node_count;
  make_gaussian_room(nodes, 0, scene);
  scene.tree.records.resize(nodes);
  scene.tree.first_child.resize(nodes);
  scene.tree.parent.resize(nodes, kNoNode);
  scene.leaves.resize(info.leaf_count, kNoNode);
}

// All of the partition but the subtrees, which are in the chunks.
void set_partition(const SceneFile& file, Scene& scene) {
  Partition& partition = scene.partition;
  const Tiers tiers = file.tiers();
  partition.first_tier_levels = tiers.first_tier_levels;
  partition.chunk_bytes = file.info().chunk_bytes;
  partition.level_begin.assign(tiers.level_begin.begin(), tiers.level_begin.end());
  partition.tier_begin.assign(tiers.tier_begin.begin(), tiers.tier_begin.end());
  partition.subtrees.assign(file.info().subtree_count, kLostSubtree);
  if (file.chunks().empty()) return;
  for (const ChunkEntry& entry : file.chunks()) {
    partition.chunk_begin.push_back(entry.first_subtree);
    partition.chunk_hull.push_back(entry.hull);
  }
  partition.chunk_begin.push_back(file.info().subtree_count);
}

// False if another node has claimed the same place in the input.
bool place_leaf(Scene& scene, uint32_t source_index, uint32_t node) {
  return std::atomic_ref<uint32_t>(scene.leaves[source_index])
             .exchange(node, std::memory_order_relaxed) == kNoNode;
}

// What loading leaves to check when all chunks are there.
struct ChunkFindings {
  std::string damage;
  int sh_degree = 0;                                      // that it uses
  float largest_sh = 0;                                   // magnitude of a coefficient
  std::vector<std::pair<uint32_t, NodeRecord>> repeated;  // node ids with their records
};

// The parents of the nodes that a subtree owns.
void store_parents(const Subtree& subtree, const NodeRecord* records, Scene& scene) {
  each_family(
      subtree, [&](uint32_t slot) { return records[slot].child_count; },
      [&](uint32_t parent, uint32_t first, uint32_t count) {
        for (uint32_t slot = std::max(first, subtree.first_owned_slot()); slot < first + count;
             ++slot)
          scene.tree.parent[subtree.node(slot)] = subtree.node(parent);
      });
}

// Chunks write apart from each other: a node is owned by one chunk, and its parent
// is set by that chunk or, for a root, by the one that owns the parent.
void store_subtrees(const Chunk& chunk, Scene& scene, ChunkFindings& findings) {
  size_t record = 0, owned = 0;
  for (size_t i = 0; i < chunk.subtrees.size(); ++i) {
    const Subtree& subtree = chunk.subtrees[i];
    scene.partition.subtrees[chunk.first_subtree + i] = subtree;
    store_parents(subtree, chunk.records.data() + record, scene);
    const uint32_t levels = subtree.root == 0 ? scene.partition.first_tier_levels : kTierLevels;
    for (uint32_t slot = 0; slot < subtree.node_count(); ++slot, ++record) {
      if (subtree.repeats(slot)) {
        findings.repeated.emplace_back(subtree.node(slot), chunk.records[record]);
        continue;
      }
      const uint32_t children = chunk.records[record].child_count;
      const uint32_t first_child = chunk.first_child[owned++];
      if (children != 0 && subtree.level(slot) + 1 == levels)
        std::fill_n(scene.tree.parent.begin() + first_child, children, subtree.node(slot));
    }
  }
}

void store_nodes(const Chunk& chunk, Scene& scene) {
  for (size_t i = 0; i < chunk.node.size(); ++i) {
    const uint32_t node = chunk.node[i];
    scene.tree.records[node] = chunk.record_of(i);
    set_gaussian(chunk, i, node, scene);
    if (!chunk.is_leaf(i)) scene.tree.first_child[node] = chunk.first_child[i];
  }
}

bool store_leaves(const Chunk& chunk, Scene& scene) {
  bool once = true;
  for (size_t i = 0; i < chunk.node.size(); ++i)
    if (chunk.is_leaf(i)) once &= place_leaf(scene, chunk.source_index[i], chunk.node[i]);
  return once;
}

// Gaussians that draw nothing, should anything draw them.
void store_damaged(const std::vector<NodeRange>& ranges, Scene& scene) {
  for (const NodeRange& range : ranges)
    for (uint32_t i = 0; i < range.count; ++i) set_nothing(range.first + i, scene);
}

void report_damage(const SceneFile& file, const std::vector<ChunkFindings>& findings,
                   Scene& scene) {
  for (uint32_t index = 0; index < findings.size(); ++index) {
    const std::string& damage = findings[index].damage;
    if (damage.empty()) continue;
    const ChunkEntry& entry = file.chunks()[index];
    const bool repeats_root = entry.place.listed_children != 0;
    const uint32_t first_root = entry.place.next[0] - (repeats_root ? 1 : 0);
    scene.damaged_chunks.push_back(
        {index, entry.first_subtree, entry.subtree_count, first_root, repeats_root, damage});
    for (const NodeRange& range : file.nodes_of(index))
      scene.damaged.push_back({range.first, range.count, damage});
    scene.notes.push_back(
        {SceneNote::Kind::damaged, entry.node_count, entry.bytes, "nodes of a chunk", damage});
  }
  std::sort(scene.damaged.begin(), scene.damaged.end(),
            [](const DamagedNodes& a, const DamagedNodes& b) { return a.first < b.first; });
}

float largest_magnitude(const std::vector<float>& values) {
  float largest = 0;
  for (const float value : values) largest = std::max(largest, std::fabs(value));
  return largest;
}

std::vector<ChunkFindings> read_chunks(const SceneFile& file, Workers& workers, Scene& scene) {
  std::vector<ChunkFindings> findings(file.chunks().size());
  std::atomic<bool> leaves_once{true};
  if (is_coded(scene)) find_code_groups(file, scene);
  workers.for_blocks(findings.size(), 8, [&](size_t begin, size_t end) {
    for (size_t index = begin; index < end; ++index) {
      try {
        const Chunk chunk = file.read_chunk(static_cast<uint32_t>(index));
        if (is_coded(scene)) set_code_scales(file, static_cast<uint32_t>(index), chunk, scene);
        store_nodes(chunk, scene);
        findings[index].sh_degree = used_sh_degree(chunk.sh, scene.sh_degree);
        findings[index].largest_sh = largest_magnitude(chunk.sh);
        store_subtrees(chunk, scene, findings[index]);
        if (!store_leaves(chunk, scene)) leaves_once = false;
      } catch (const Error& error) {
        if (error.code() != ErrorCode::damaged_chunk) throw;
        findings[index].damage = error.what();
        store_damaged(file.nodes_of(static_cast<uint32_t>(index)), scene);
      }
    }
  });
  if (!leaves_once) refuse(scene, "two leaves with one source index", "each index once");
  report_damage(file, findings, scene);
  for (const ChunkFindings& f : findings)
    scene.profile.chunks_of_degree[static_cast<size_t>(f.sh_degree)] += f.damage.empty();
  return findings;
}

// A lost chunk may hold children of a node that another owns: a search must find that
// it needs them. A parent that is named already is never named anew, so that ranges
// which overlap, as an unsound file may claim, cost no more than sound ones.
void name_parents_of_lost_nodes(Scene& scene) {
  if (scene.damaged.empty()) return;
  LodTree& tree = scene.tree;
  for (uint32_t node = 0; node < tree.size(); ++node) {
    const uint32_t first = tree.first_child[node], count = tree.records[node].child_count;
    for (uint32_t child = first; child - first < count; ++child) {
      if (tree.parent[child] == kNoNode) tree.parent[child] = node;
      if (tree.parent[child] != node) break;
    }
  }
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
      if (parent == kNoNode || is_inside(tree.records[n], tree.records[parent])) continue;
      const auto node = static_cast<uint32_t>(n);
      if (is_damaged(scene, node) || is_damaged(scene, parent)) continue;
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

// A repeated record is compared in its owner's stead.
void check_repeats(const Scene& scene, const std::vector<ChunkFindings>& findings) {
  for (size_t index = 0; index < findings.size(); ++index)
    for (const auto& [node, record] : findings[index].repeated)
      if (!is_same(record, scene.tree.records[node]) && !is_damaged(scene, node))
        refuse(scene,
               "chunk " + std::to_string(index) + " repeating node " + std::to_string(node) +
                   " with another record",
               "the node's own");
}

bool covers(const EntryHull& hull, const LodTree& tree, uint32_t parent) {
  if (parent == kNoNode) return hull.extent == std::numeric_limits<float>::infinity();
  return is_inside(tree.records[parent], {hull.box_min, hull.extent, hull.box_max, 0});
}

// A hull that is too small would let a search skip nodes of the cut.
void check_hulls(const Scene& scene) {
  const Partition& partition = scene.partition;
  for (size_t chunk = 0; chunk < partition.chunk_count(); ++chunk)
    for (uint32_t i = partition.chunk_begin[chunk]; i < partition.chunk_begin[chunk + 1]; ++i) {
      const Subtree& subtree = partition.subtrees[i];
      if (subtree.root == kNoNode) continue;
      const uint32_t node = subtree.first_owned(), parent = scene.tree.parent[node];
      if (covers(partition.chunk_hull[chunk], scene.tree, parent)) continue;
      if (node != 0 && (parent == kNoNode || is_damaged(scene, parent))) continue;
      refuse(scene,
             "an entry hull of chunk " + std::to_string(chunk) + " without the parent of node " +
                 std::to_string(node),
             "a hull over the entry parents");
    }
}

// A search opens a subtree by what its first root hangs from.
void check_siblings(const Scene& scene) {
  const auto& parent = scene.tree.parent;
  for (const Subtree& subtree : scene.partition.subtrees)
    for (uint32_t slot = 1; slot < subtree.root_count; ++slot)
      if (parent[subtree.node(slot)] != parent[subtree.root])
        refuse(scene,
               "a subtree whose roots from node " + std::to_string(subtree.root) +
                   " on hang from several nodes",
               "roots of one node");
}

// What the header says for readers that never see the whole.
void check_claims(const SceneFileInfo& info, const Scene& scene,
                  const std::vector<ChunkFindings>& findings) {
  float largest = 0;
  for (const ChunkFindings& f : findings) largest = std::max(largest, f.largest_sh);
  if (largest != info.largest_sh)
    refuse(scene, "a largest SH coefficient of " + std::to_string(largest),
           "the header's " + std::to_string(info.largest_sh));
  const auto has_extent = [](const NodeRecord& r) { return r.child_count == 0 && r.extent != 0; };
  if (info.leaves_have_extent &&
      std::none_of(scene.tree.records.begin(), scene.tree.records.end(), has_extent))
    refuse(scene, "no leaf with an extent", "at least one, as the header says");
}

// What only the whole file can show.
void check_totals(const Scene& scene) {
  if (std::count(scene.leaves.begin(), scene.leaves.end(), kNoNode) != 0)
    refuse(scene, "an input Gaussian without a leaf", "one leaf for each");
  const auto leaves =
      static_cast<uint64_t>(std::count_if(scene.tree.records.begin(), scene.tree.records.end(),
                                          [](const NodeRecord& r) { return r.child_count == 0; }));
  if (leaves != scene.leaf_count)
    refuse(scene, std::to_string(leaves) + " leaves", std::to_string(scene.leaf_count));
  const NodeRecord& root = scene.tree.records[0];
  for (int axis = 0; axis < 3; ++axis)
    if (root.box_min[axis] != scene.bounds_min[axis] ||
        root.box_max[axis] != scene.bounds_max[axis])
      refuse(scene, "bounds that differ from the root's box", "equal ones");
}

void add_search(Scene& scene, Workers& workers) {
  std::vector<SubtreeRange> missing;
  for (const DamagedChunk& d : scene.damaged_chunks)
    missing.push_back(
        {d.first_subtree, d.first_subtree + d.subtree_count, d.first_root, d.repeats_root});
  scene.search = make_search_tree(scene.tree, scene.partition, missing, workers,
                                  scene.tree.records.get_allocator().resource());
}

}  // namespace

void load_baked(const SceneFile& file, Workers& workers, Scene& scene) {
  set_info(file.info(), scene);
  make_room(file.info(), scene);
  set_partition(file, scene);
  const std::vector<ChunkFindings> findings = read_chunks(file, workers, scene);
  name_parents_of_lost_nodes(scene);
  check_repeats(scene, findings);
  check_nesting(scene, workers);
  check_hulls(scene);
  check_siblings(scene);
  if (scene.damaged.empty() && scene.tree.size() != 0) {
    check_totals(scene);
    check_claims(file.info(), scene, findings);
  }
  round_bounds(scene.tree, workers);
  add_search(scene, workers);
  leave_out_records(scene);
  int used = 0;
  for (const ChunkFindings& f : findings) used = std::max(used, f.sh_degree);
  lower_sh_degree(used, scene);
  complete_profile(scene, workers);
  add_notes(scene);
}

}  // namespace voyager
