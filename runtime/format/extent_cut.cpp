#include "runtime/format/extent_cut.h"

#include <algorithm>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/format/append_flat.h"
#include "runtime/format/tree_check.h"

namespace voyager {
namespace {

// By node id.
struct ExtentTree {
  explicit ExtentTree(size_t count) : extent(count), child_count(count) {}
  std::vector<float> extent;
  std::vector<uint32_t> child_count;
};

ExtentTree read_tree(const SceneFile& scene, const Progress& progress) {
  ExtentTree tree(scene.info().node_count);
  TreeCheck check(scene);
  for (uint32_t index = 0; index < scene.chunks().size(); ++index) {
    report(progress, "exporting", index, 2 * scene.chunks().size());
    const Chunk chunk = scene.read_chunk(index);
    check.add(chunk, index);
    for (size_t i = 0; i < chunk.node.size(); ++i) {
      tree.extent[chunk.node[i]] = chunk.record_of(i).extent;
      tree.child_count[chunk.node[i]] = chunk.record_of(i).child_count;
    }
  }
  uint64_t children = 0;
  for (const uint32_t count : tree.child_count) children += count;
  if (children + 1 != std::max<size_t>(1, tree.extent.size()))
    throw Error(ErrorCode::refused_input, scene.name() + ": found " + std::to_string(children) +
                                              " children, expected one for each node but the root");
  return tree;
}

// Extents above it are refined. Refining a node of k children adds k - 1 to the cut.
float threshold_of(const ExtentTree& tree, uint64_t most) {
  std::vector<uint32_t> interior;
  for (uint32_t n = 0; n < tree.extent.size(); ++n)
    if (tree.child_count[n] > 0) interior.push_back(n);
  std::sort(interior.begin(), interior.end(),
            [&](uint32_t a, uint32_t b) { return tree.extent[a] > tree.extent[b]; });
  uint64_t size = 1;
  for (size_t i = 0; i < interior.size();) {
    const float extent = tree.extent[interior[i]];
    for (; i < interior.size() && tree.extent[interior[i]] == extent; ++i)
      size += tree.child_count[interior[i]] - 1;
    if (size > most) return extent;
  }
  return -1.0f;  // every leaf
}

// By node id. Children come after their parent, and those of one node after those of the node
// before it.
std::vector<bool> nodes_of_cut(const ExtentTree& tree, float threshold) {
  std::vector<bool> cut(tree.extent.size());
  if (!cut.empty()) cut[0] = true;
  size_t first_child = 1;
  for (size_t n = 0; n < cut.size(); ++n) {
    const uint32_t count = tree.child_count[n];
    if (cut[n] && count > 0 && tree.extent[n] > threshold) {
      cut[n] = false;
      std::fill_n(cut.begin() + static_cast<std::ptrdiff_t>(first_child), count, true);
    }
    first_child += count;
  }
  return cut;
}

}  // namespace

GaussianCloud read_extent_cut(const SceneFile& scene, uint64_t most, const Progress& progress) {
  const SceneFileInfo& info = scene.info();
  const ExtentTree tree = read_tree(scene, progress);
  const std::vector<bool> cut = nodes_of_cut(tree, threshold_of(tree, most));
  GaussianCloud cloud;
  cloud.sh_degree = info.sh_degree;
  cloud.left_out_bands = info.left_out_bands;
  cloud.native = info.native;
  cloud.origin = info.origin;
  const size_t chunks = scene.chunks().size();
  for (uint32_t index = 0; index < chunks; ++index) {
    report(progress, "exporting", chunks + index, 2 * chunks);
    const Chunk chunk = scene.read_chunk(index);
    for (size_t i = 0; i < chunk.node.size(); ++i)
      if (cut[chunk.node[i]]) append_flat(chunk, i, cloud);
  }
  return cloud;
}

GaussianCloud extent_cut(const BakedScene& baked, uint64_t most) {
  ExtentTree tree(baked.tree.size());
  for (size_t n = 0; n < baked.tree.size(); ++n) {
    tree.extent[n] = baked.tree.records[n].extent;
    tree.child_count[n] = baked.tree.records[n].child_count;
  }
  const std::vector<bool> cut = nodes_of_cut(tree, threshold_of(tree, most));
  GaussianCloud cloud;
  cloud.sh_degree = baked.leaves.sh_degree;
  cloud.left_out_bands = baked.leaves.left_out_bands;
  cloud.native = baked.leaves.native;
  cloud.origin = baked.origin;
  const auto floats = static_cast<size_t>(cloud.coefficients()) * 3;
  for (uint32_t n = 0; n < cut.size(); ++n) {
    if (!cut[n]) continue;
    const size_t i = baked.gaussian[n];
    const bool leaf = baked.tree.is_leaf(n);
    append_flat(leaf ? leaf_words(baked, i) : baked.merged.words(i), baked.has_logit(n),
                &(leaf ? baked.leaves : baked.merged).sh[i * floats], cloud);
  }
  return cloud;
}

}  // namespace voyager
