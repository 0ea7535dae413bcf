#pragma once
// Sound LoD trees of many shapes, for what depends on the tree alone: boxes nest,
// extents never grow downwards, ids are breadth-first (runtime/lod/tree.h).
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "runtime/lod/tree.h"
#include "runtime/lod/tree_rule.h"

namespace voyager::test {

enum class TreeShape {
  chain,          // one child each, along a line
  star,           // a root and leaves
  star_of_stars,  // a root, √n hubs, leaves
  recursive,      // each node under a uniformly chosen earlier one
  binary,
  four_way,
  eight_way,
  mixture,  // pieces of chains, stars and four-way trees
  uneven,   // a chain with small bushes along it
};
inline constexpr TreeShape kTreeShapes[] = {
    TreeShape::chain,     TreeShape::star,    TreeShape::star_of_stars,
    TreeShape::recursive, TreeShape::binary,  TreeShape::four_way,
    TreeShape::eight_way, TreeShape::mixture, TreeShape::uneven};

inline std::string name_of(TreeShape shape) {
  constexpr const char* kNames[] = {"chain",    "star",      "star of stars", "recursive", "binary",
                                    "four-way", "eight-way", "mixture",       "uneven"};
  return kNames[static_cast<size_t>(shape)];
}

enum class Extents {
  longest_side,  // of the box, 0 for a leaf: the compatible choice
  any,           // random, also above 0 for leaves; often equal to the parent's
};

// Uniform on [0, 1), the same on every platform.
inline float unit(std::mt19937& random) {
  return static_cast<float>(random() >> 8) / 16777216.0f;
}

// The earlier node that node i > 0 hangs under.
inline uint32_t random_parent(TreeShape shape, uint32_t i, uint32_t nodes, uint32_t hub,
                              std::mt19937& random) {
  const auto hubs = static_cast<uint32_t>(std::sqrt(static_cast<float>(nodes)));
  switch (shape) {
    case TreeShape::chain:
      return i - 1;
    case TreeShape::star:
      return 0;
    case TreeShape::star_of_stars:
      return i <= hubs ? 0 : 1 + random() % hubs;
    case TreeShape::recursive:
      return random() % i;
    case TreeShape::binary:
      return (i - 1) / 2;
    case TreeShape::four_way:
      return (i - 1) / 4;
    case TreeShape::eight_way:
      return (i - 1) / 8;
    case TreeShape::mixture:
      return i % 300 < 80 ? i - 1 : i % 300 < 200 ? hub : (i - 1) / 4;
    case TreeShape::uneven:
      return random() % 3 != 0 ? hub : hub + random() % (i - hub);
  }
  return 0;
}

// Child counts in breadth-first order: the whole topology.
inline std::vector<uint32_t> random_child_counts(TreeShape shape, uint32_t nodes,
                                                 std::mt19937& random) {
  std::vector<std::vector<uint32_t>> children(nodes);
  uint32_t hub = 0;
  for (uint32_t i = 1; i < nodes; ++i) {
    const uint32_t parent = random_parent(shape, i, nodes, hub, random);
    children[parent].push_back(i);
    const bool next_hub = shape == TreeShape::uneven ? random() % 4 == 0 : random() % 60 == 0;
    if (next_hub && (shape == TreeShape::mixture || parent == hub)) hub = i;
  }
  std::vector<uint32_t> order{0}, counts;
  for (uint32_t at = 0; at < nodes; ++at) {
    const std::vector<uint32_t>& own = children[order[at]];
    counts.push_back(static_cast<uint32_t>(own.size()));
    order.insert(order.end(), own.begin(), own.end());
  }
  return counts;
}

inline LodTree linked_tree(const std::vector<uint32_t>& child_counts) {
  LodTree tree;
  const size_t nodes = child_counts.size();
  tree.records.resize(nodes);
  tree.first_child.resize(nodes);
  tree.parent.assign(nodes, kNoNode);
  uint32_t next = 1;
  for (uint32_t n = 0; n < nodes; ++n) {
    tree.records[n].child_count = child_counts[n];
    tree.first_child[n] = next;
    std::fill_n(tree.parent.begin() + next, child_counts[n], n);
    next += child_counts[n];
  }
  return tree;
}

// Where each node's own cube is: near its parent's, the nearer the more siblings it has.
inline std::vector<Vec3f> random_places(const LodTree& tree, std::mt19937& random) {
  std::vector<Vec3f> place(tree.size());
  std::vector<float> reach(tree.size());
  reach[0] = 100.0f / 3;  // metres
  for (uint32_t n = 1; n < tree.size(); ++n) {
    const uint32_t p = tree.parent[n], siblings = tree.records[p].child_count;
    const float step = siblings == 1 ? 0.05f : reach[p];
    place[n] = place[p];
    for (int axis = 0; axis < (siblings == 1 ? 1 : 3); ++axis)
      place[n][axis] += step * (siblings == 1 ? 1.0f : 2 * unit(random) - 1);
    reach[n] = std::max(0.01f, reach[p] / std::cbrt(static_cast<float>(siblings)));
  }
  return place;
}

inline void grow_box(NodeRecord& box, const Vec3f& least, const Vec3f& most) {
  for (int axis = 0; axis < 3; ++axis) {
    box.box_min[axis] = std::min(box.box_min[axis], least[axis]);
    box.box_max[axis] = std::max(box.box_max[axis], most[axis]);
  }
}

inline float longest_side(const NodeRecord& r) {
  return std::max(
      {r.box_max.x - r.box_min.x, r.box_max.y - r.box_min.y, r.box_max.z - r.box_min.z});
}

// Leaves are small cubes, interior boxes the hulls of their children; a node with
// one child has a cube of its own too, so that a chain's boxes differ.
inline void set_boxes(LodTree& tree, std::mt19937& random) {
  const std::vector<Vec3f> place = random_places(tree, random);
  for (auto n = static_cast<uint32_t>(tree.size()); n-- > 0;) {
    NodeRecord& r = tree.records[n];
    r.box_min = {1e17f, 1e17f, 1e17f};
    r.box_max = {-1e17f, -1e17f, -1e17f};
    const float side = 0.02f + 0.2f * unit(random);
    const Vec3f half{side, side, side};
    if (r.child_count < 2) grow_box(r, place[n] - half, place[n] + half);
    for (uint32_t i = 0; i < r.child_count; ++i) {
      const NodeRecord& child = tree.records[tree.first_child[n] + i];
      grow_box(r, child.box_min, child.box_max);
    }
  }
}

inline void set_extents(LodTree& tree, Extents extents, std::mt19937& random) {
  for (auto n = static_cast<uint32_t>(tree.size()); n-- > 0;) {
    NodeRecord& r = tree.records[n];
    if (extents == Extents::longest_side) {
      r.extent = r.child_count == 0 ? 0.0f : longest_side(r);
      continue;
    }
    r.extent = r.child_count == 0 && random() % 2 ? 0.1f * unit(random) : 0.0f;
    for (uint32_t i = 0; i < r.child_count; ++i)
      r.extent = std::max(r.extent, tree.records[tree.first_child[n] + i].extent);
    if (random() % 4 != 0) r.extent += 0.3f * unit(random) * longest_side(r);
  }
}

// Deterministic for its arguments. Of `nodes` > 0 nodes, in a region of about 200 m;
// a chain is longer.
inline LodTree random_tree(TreeShape shape, uint32_t nodes, uint32_t seed,
                           Extents extents = Extents::longest_side) {
  std::mt19937 random(seed);
  LodTree tree = linked_tree(random_child_counts(shape, nodes, random));
  tree.blend_share = extents == Extents::any ? kLateShare : kHalfShare;
  set_boxes(tree, random);
  set_extents(tree, extents, random);
  return tree;
}

// Chains of so many nodes each, all from one root: every level has many subtrees, and of a cut few
// nodes.
inline LodTree tree_of_chains(uint32_t chains, uint32_t length, uint32_t seed) {
  std::vector<uint32_t> child_counts{chains};
  child_counts.insert(child_counts.end(), size_t{chains} * (length - 1), 1);
  child_counts.insert(child_counts.end(), chains, 0);
  std::mt19937 random(seed);
  LodTree tree = linked_tree(child_counts);
  tree.blend_share = kHalfShare;
  set_boxes(tree, random);
  set_extents(tree, Extents::longest_side, random);
  return tree;
}

inline LodTree moved(LodTree tree, float scale, const Vec3f& shift) {
  for (NodeRecord& r : tree.records) {
    r.box_min = scale * r.box_min + shift;
    r.box_max = scale * r.box_max + shift;
    r.extent *= scale;
  }
  return tree;
}

}  // namespace voyager::test
