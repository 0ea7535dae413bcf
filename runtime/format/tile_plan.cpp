#include "runtime/format/tile_plan.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

namespace voyager {
namespace {

constexpr uint32_t kParts = 8;      // of a tile's leaves, each part has one of so many
constexpr double kMostError = 1e9;  // metres: JSON has no infinity
constexpr double kMore = 1 + 1e-6, kLeast = 1e-9;  // than of the children: errors differ

class Planner {
 public:
  Planner(const TileTree& tree, uint64_t most) : tree_(tree), most_(most) {}

  std::vector<Tile> run() {
    if (tree_.size() == 0) return {};
    add({0}, kNoTile);
    for (size_t i = 0; i < tiles_.size(); ++i)
      if (tiles_[i].threshold >= 0) divide(i);
    set_errors();
    return std::move(tiles_);
  }

 private:
  void add(std::vector<uint32_t> nodes, size_t parent) {
    Tile tile;
    tile.threshold = leaves_of(nodes) <= most_ ? -1.0f : threshold_of(nodes.front());
    tile.nodes = std::move(nodes);
    tile.parent = parent;
    if (parent != kNoTile) tiles_[parent].children.push_back(tiles_.size());
    tiles_.push_back(std::move(tile));
  }

  uint64_t leaves_of(const std::vector<uint32_t>& nodes) const {
    uint64_t leaves = 0;
    for (const uint32_t node : nodes) leaves += tree_.leaves[node];
    return leaves;
  }

  // Of one node: the least threshold with at most so many Gaussians.
  float threshold_of(uint32_t root) const {
    const auto smaller = [&](uint32_t a, uint32_t b) { return tree_.extent[a] < tree_.extent[b]; };
    std::priority_queue<uint32_t, std::vector<uint32_t>, decltype(smaller)> inner(smaller);
    inner.push(root);
    for (uint64_t size = 1; !inner.empty();) {
      const float extent = tree_.extent[inner.top()];
      while (!inner.empty() && tree_.extent[inner.top()] == extent) {
        const uint32_t node = inner.top();
        inner.pop();
        size += tree_.child_count[node] - 1;
        if (size > most_) return extent;
        for (uint32_t i = 0; i < tree_.child_count[node]; ++i)
          if (const uint32_t child = tree_.first_child[node] + i; tree_.child_count[child] > 0)
            inner.push(child);
      }
    }
    return -1;
  }

  // A tile with children has one node.
  void divide(size_t tile) {
    const uint32_t root = tiles_[tile].nodes.front();
    const uint64_t part = std::max<uint64_t>(most_, tree_.leaves[root] / kParts);
    std::vector<uint32_t> open{root}, shared;
    uint64_t leaves = 0;  // of the shared ones
    const auto close = [&] {
      if (!shared.empty()) add(std::exchange(shared, {}), tile);
      leaves = 0;
    };
    while (!open.empty()) {
      const uint32_t node = open.back();
      open.pop_back();
      if (node == root || tree_.leaves[node] > part) {
        for (uint32_t i = tree_.child_count[node]; i-- > 0;)
          open.push_back(tree_.first_child[node] + i);
        continue;
      }
      if (tree_.leaves[node] > most_) {
        add({node}, tile);
        continue;
      }
      if (leaves + tree_.leaves[node] > most_) close();
      shared.push_back(node);
      leaves += tree_.leaves[node];
    }
    close();
  }

  void set_errors() {
    for (size_t i = tiles_.size(); i-- > 0;) {
      Tile& tile = tiles_[i];
      if (tile.children.empty()) continue;
      double below = 0;
      for (const size_t child : tile.children) below = std::max(below, tiles_[child].error);
      const double own = std::min(kMostError, static_cast<double>(tile.threshold));
      tile.error = std::max(own, below * kMore + kLeast);
    }
  }

  const TileTree& tree_;
  uint64_t most_;
  std::vector<Tile> tiles_;
};

}  // namespace

bool link_tiles(TileTree& tree) {
  uint64_t next = 1;
  for (size_t n = 0; n < tree.size(); ++n) {
    if (n >= next) return false;
    tree.first_child[n] = static_cast<uint32_t>(next);
    next += tree.child_count[n];
    if (next > tree.size()) return false;
  }
  if (tree.size() != 0 && next != tree.size()) return false;
  for (size_t n = tree.size(); n-- > 0;) {
    uint32_t leaves = tree.child_count[n] == 0 ? 1 : 0;
    for (uint32_t i = 0; i < tree.child_count[n]; ++i)
      leaves += tree.leaves[tree.first_child[n] + i];
    tree.leaves[n] = leaves;
  }
  return true;
}

std::vector<Tile> plan_tiles(const TileTree& tree, uint64_t most) {
  return Planner(tree, most).run();
}

std::vector<uint32_t> nodes_of_tile(const TileTree& tree, const Tile& tile) {
  std::vector<uint32_t> open = tile.nodes, shown;
  while (!open.empty()) {
    const uint32_t node = open.back();
    open.pop_back();
    if (tree.child_count[node] == 0 || !(tree.extent[node] > tile.threshold)) {
      shown.push_back(node);
      continue;
    }
    for (uint32_t i = 0; i < tree.child_count[node]; ++i)
      open.push_back(tree.first_child[node] + i);
  }
  std::sort(shown.begin(), shown.end());
  return shown;
}

}  // namespace voyager
