#pragma once
// What a bake in parts knows from counts alone, because the shape of the tree depends
// on the number of Gaussians only (runtime/lod/shape.h): which part of the tree each
// cell holds, and which subtrees and chunks of the file are in it.
//
// The nodes of one level, the cells' roots, cut the tree into cells and a top. Chunks
// are runs of subtrees, tier by tier; the first tier whose roots lie on the cells'
// level or below it and all after it are the cells' ("cell tiers"), those before it
// the top's. A segment is what one cell, or the top, has of one tier.
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "runtime/lod/subtree_cursor.h"

namespace voyager {

struct Segment {
  uint32_t tier;
  uint32_t cell;           // kTop for the top
  uint32_t first_subtree;  // of the file
  // Bytes of records in the chunk that subtrees before this segment left open; 0 before
  // the first subtree of all.
  uint32_t open_bytes;
  uint32_t chunks_before;  // begun before this segment
  SubtreePlace place;
};

class BakePlan {
 public:
  static constexpr uint32_t kTop = 0xffffffffu;
  // Least Gaussians of a cell: the splits above it, and two levels below its root, are full.
  static constexpr uint32_t kLeastCell = 1024;

  // The deepest level that cells may be on; 0 where the scene is too small for any.
  static uint32_t deepest_level(uint32_t gaussians);
  // Gaussians of the largest cell of a level.
  static uint32_t largest_cell(uint32_t gaussians, uint32_t level);

  // cell_level is 1 to deepest_level(); chunk_bytes as partition_tree() takes them.
  BakePlan(uint32_t gaussians, uint32_t cell_level, uint32_t chunk_bytes);

  uint32_t gaussians() const { return gaussians_; }
  uint32_t cell_level() const { return cell_level_; }
  uint32_t cells() const { return static_cast<uint32_t>(cell_sizes_.size()); }
  uint32_t cell_size(uint32_t cell) const { return cell_sizes_[cell]; }
  uint32_t chunk_count() const { return chunk_count_; }
  uint32_t chunk_bytes() const { return chunk_bytes_; }
  Tiers tiers() const { return {first_tier_levels_, level_begin_, tier_begin_}; }

  // Levels of the top: all above the cell tiers, and the cells' roots.
  uint32_t top_levels() const { return top_levels_; }
  uint32_t first_cell_tier() const { return first_cell_tier_; }
  // Of the roots of a cell tier, in the cell's own tree.
  uint32_t cell_level_of(uint32_t tier) const;
  // The cell's first node on one of its own levels.
  uint32_t first_node(uint32_t cell, uint32_t level) const;

  // In the order of the file; those of a tier are consecutive.
  std::span<const Segment> segments(uint32_t tier) const;

 private:
  // What cells of one size have in common.
  struct CellShape {
    std::vector<uint32_t> levels;                  // nodes of each
    std::vector<std::vector<uint8_t>> tier_nodes;  // of each subtree of each cell tier
  };

  void lay_out_levels();
  void lay_out_cells();
  void lay_out_segments();
  CellShape shape_of(uint32_t size) const;
  void add_segment(uint32_t tier, uint32_t cell, const SubtreePlace& place,
                   const std::vector<uint8_t>& nodes);
  SubtreePlace top_place(uint32_t tier) const;

  uint32_t gaussians_, cell_level_, chunk_bytes_;
  uint32_t first_tier_levels_ = 0, top_levels_ = 0, first_cell_tier_ = 0, chunk_count_ = 0;
  std::vector<uint32_t> level_begin_, tier_begin_;
  std::vector<uint32_t> cell_sizes_;
  std::map<uint32_t, CellShape> shapes_;          // by size: few
  std::vector<std::vector<uint32_t>> cell_node_;  // of each cell's level, the first node
  std::vector<Segment> segments_;
  std::vector<uint32_t> tier_segment_;  // first of each tier, and their number
  uint32_t open_bytes_ = 0, subtrees_ = 0;
};

// Gaussians under each node of a level, in order; level 0 is the root.
std::vector<uint32_t> sizes_on_level(uint32_t gaussians, uint32_t level);

}  // namespace voyager
