#pragma once
// The bytes of HierarchicalGS's .hier, little-endian (docs/voy-format.md, "The .hier export"):
//   int32 P; arrays of P positions (3), rotations (w, x, y, z), log scales (3), linear opacities
//   and SH ([16][3]); int32 N; N nodes; N boxes.
// Compressed files have -P in place of P. In these, all but positions and whole numbers is
// binary16, and a node is a HalfHierNode.
#include <bit>
#include <cstddef>
#include <cstdint>

#include "runtime/math/vec.h"

namespace voyager {

static_assert(std::endian::native == std::endian::little);

inline constexpr size_t kHierShFloats = 48;  // [16][3]: always degree 3
// Floats of a Gaussian: position, rotation, log scale, opacity, SH.
inline constexpr size_t kHierFloats = 3 + 4 + 3 + 1 + kHierShFloats;

struct HierNode {
  int32_t depth;   // 0 for a leaf
  int32_t parent;  // -1 for the root
  int32_t start;   // its first Gaussian; count_leafs leaves, then count_merged merged ones
  int32_t count_leafs, count_merged;
  int32_t start_children, count_children;
};
static_assert(sizeof(HierNode) == 28);

struct HalfHierNode {
  int32_t parent, start, start_children;
  int16_t depth, count_children, count_leafs, count_merged;
};
static_assert(sizeof(HalfHierNode) == 20);

struct HierBox {
  Vec3f min;
  float size;  // the extent
  Vec3f max;
  float size_again;
};
static_assert(sizeof(HierBox) == 32);

inline constexpr size_t kHalfHierBoxBytes = 16;  // a HierBox in binary16

// Where each array starts in a file, in bytes.
struct HierLayout {
  HierLayout(uint64_t gaussians, uint64_t node_rows, bool in_halves = false)
      : value(in_halves ? 2 : 4),
        positions(4),
        rotations(positions + 12 * gaussians),
        log_scales(rotations + 4 * value * gaussians),
        opacities(log_scales + 3 * value * gaussians),
        sh(opacities + value * gaussians),
        node_count(sh + kHierShFloats * value * gaussians),
        nodes(node_count + 4),
        boxes(nodes + (in_halves ? sizeof(HalfHierNode) : sizeof(HierNode)) * node_rows),
        end(boxes + (in_halves ? kHalfHierBoxBytes : sizeof(HierBox)) * node_rows) {}
  uint64_t value;  // bytes of a number that is not a position
  uint64_t positions, rotations, log_scales, opacities, sh, node_count, nodes, boxes, end;
};

}  // namespace voyager
