#pragma once
// Which part of the file each cell has: made when all cells are built, from the topology
// of their trees. Cells of one size may differ in shape and in depth.
//
// The nodes of one level, the cells' roots, cut the tree into cells and a top. Chunks
// are runs of subtrees, tier by tier; the first tier whose roots lie on the cells'
// level or below it and all after it are the cells' ("cell tiers"), those before it
// the top's. A segment is what one cell, or the top, has of one tier.
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "runtime/bake/cell_shape.h"
#include "runtime/base/workers.h"
#include "runtime/lod/subtree_cursor.h"

namespace voyager {

struct Segment {
  uint32_t tier;
  uint32_t cell;           // kTop for the top
  uint32_t first_subtree;  // its index in the file
  // Bytes of records in the chunk that subtrees before this segment left open; 0 before
  // the first subtree of all.
  uint32_t open_bytes;
  uint32_t chunks_before;  // begun before this segment
  SubtreePlace place;
};

class BakePlan {
 public:
  static constexpr uint32_t kTop = 0xffffffffu;

  // The child counts of a cell's nodes, as cell_levels() takes them (cell_shape.h).
  using ShapeOf = std::function<std::vector<uint8_t>(uint32_t cell)>;

  // Above cell_level ≥ 1 every node has kChildren children. chunk_bytes as
  // partition_tree() takes them. `shape_of` is called twice for each cell, by several
  // threads. While the plan is made, there is a byte for each root of the cells' subtrees.
  // Throws Error(internal) for a cell that cell_levels() refuses.
  BakePlan(uint32_t cell_level, uint32_t chunk_bytes, const ShapeOf& shape_of, Workers& workers);

  uint32_t cell_level() const { return cell_level_; }
  uint32_t cells() const { return cells_; }
  uint32_t chunk_count() const { return chunk_count_; }
  uint32_t chunk_bytes() const { return chunk_bytes_; }
  Tiers tiers() const { return {first_tier_levels_, level_begin_, tier_begin_}; }

  // Levels of the top: all above the cell tiers, and the cells' roots.
  uint32_t top_levels() const { return top_levels_; }
  uint32_t first_cell_tier() const { return first_cell_tier_; }
  // The level, in a cell's own tree, of the roots of a cell tier.
  uint32_t cell_level_of(uint32_t tier) const;
  // The id in the file of the cell's first node on one of its own levels, or where it would
  // be. For cell == cells() it is the end of the level.
  uint32_t first_node(uint32_t cell, uint32_t level) const;

  // In the order of the file; those of a tier are consecutive.
  std::span<const Segment> segments(uint32_t tier) const;

 private:
  using Lists = std::vector<std::vector<uint32_t>>;

  void lay_out_levels(const Lists& cell_levels);
  void lay_out_tiers();
  void lay_out_segments(const ShapeOf& shape_of, Workers& workers);
  void add_segment(uint32_t tier, uint32_t cell, const SubtreePlace& place,
                   const std::vector<RootShape>& roots);
  SubtreePlace top_place(uint32_t tier) const;
  std::vector<RootShape> top_shapes(uint32_t tier) const;

  uint32_t cell_level_, cells_, chunk_bytes_;
  uint32_t first_tier_levels_ = 0, top_levels_ = 0, first_cell_tier_ = 0, chunk_count_ = 0;
  std::vector<uint32_t> level_begin_, tier_begin_;
  Lists cell_node_;  // of each level of cells: first_node() of each
  std::vector<Segment> segments_;
  std::vector<uint32_t> tier_segment_;  // first of each tier, and their number
  uint32_t open_bytes_ = 0, subtrees_ = 0;
};

}  // namespace voyager
