#pragma once
// Which Gaussians go into which tile of a tileset (export_tileset.h).
//
// A tile shows the subtrees of its nodes by the cut that has at most so many Gaussians: the nodes
// with the greatest extents are refined, those of one extent together. Where that reaches every
// leaf, the tile has no children. Else its children have the same subtree between them, each a part
// of an eighth of its leaves or fewer; parts that are small share a tile.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voyager {

// By node id. Leaves are those of the node's subtree.
struct TileTree {
  explicit TileTree(size_t nodes = 0)
      : extent(nodes), child_count(nodes), first_child(nodes), leaves(nodes) {}
  size_t size() const { return extent.size(); }

  std::vector<float> extent;
  std::vector<uint32_t> child_count, first_child, leaves;
};

// Fills first_child and leaves of a tree whose nodes are breadth-first, from child_count. False
// where the counts are no tree of so many nodes.
bool link_tiles(TileTree& tree);

inline constexpr size_t kNoTile = SIZE_MAX;

struct Tile {
  std::vector<uint32_t> nodes;  // whose subtrees it shows
  size_t parent = kNoTile;
  float threshold = -1;  // extents above it are refined; -1: every leaf
  // The error of showing it and not its children, as an extent: of the nodes that it shows in place
  // of their children the greatest. Less than the parent's; 0 without children.
  double error = 0;
  std::vector<size_t> children;
};

// The root first, and parents before their children. No tile has more than `most` Gaussians unless
// the children of one node are more, of one node then. `most` is at least 1. None for an empty
// tree.
std::vector<Tile> plan_tiles(const TileTree& tree, uint64_t most);

// The nodes that a tile shows, ascending.
std::vector<uint32_t> nodes_of_tile(const TileTree& tree, const Tile& tile);

}  // namespace voyager
