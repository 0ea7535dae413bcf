#pragma once
// The arrays that a sweep reads, on the device: shared by all views of a scene.
#include "cuda/device/buffer.h"
#include "runtime/lod/tree.h"

namespace voyager::cuda {

// Of 32 consecutive nodes. Ids are breadth-first and siblings are neighbours, so that two bits a
// node say which record is a node's own, and which its parent's.
struct SweepWord {
  uint32_t interior;         // bits: nodes with children
  uint32_t interior_before;  // nodes with children in earlier words
  uint32_t first_children;   // bits: nodes that are the first child of their parent
  uint32_t families_before;  // first children in earlier words
};

// As kernels take it. A record for each node with children, in the order of ids.
struct SweepView {
  const float4* low;  // box_min and extent
  const Vec3f* high;  // box_max
  const SweepWord* words;
  uint32_t records, nodes;
  float blend_share;  // LodTree's
};

// Device memory: 28 bytes a node with children, half a byte a node.
class SweepTree {
 public:
  // Leaves have no extent.
  explicit SweepTree(const LodTree& tree);

  SweepView view() const;

 private:
  Buffer<float4> low_;
  Buffer<Vec3f> high_;
  Buffer<SweepWord> words_;
  uint32_t nodes_;
  float blend_share_;
};

}  // namespace voyager::cuda
