#pragma once
// One chunk in memory: contiguous subtrees with the records of their nodes, and the
// words of the Gaussians of the nodes that they own (compact storage: dequantised to
// the same words). A repeated node has a record, but its Gaussian is with its owner.
#include <array>
#include <cstdint>
#include <vector>

#include "runtime/lod/subtrees.h"
#include "runtime/math/gaussian.h"
#include "runtime/math/mean_code.h"
#include "runtime/math/sh_code.h"

namespace voyager {

struct Chunk {
  uint32_t first_subtree = 0;
  std::vector<Subtree> subtrees;

  // By subtree, then by slot.
  std::vector<NodeRecord> records;

  // Of the owned nodes, in the order of their records.
  std::vector<uint32_t> node;
  std::vector<uint32_t> record;       // its index in records
  std::vector<uint32_t> first_child;  // meaningless for a leaf
  std::vector<GaussianWords> words;   // scene-local means; leaf opacity is a logit, merged linear
  bool linear_leaves = false;         // of a .hier's tree: leaf opacities are linear, too
  std::vector<float> sh;              // coefficients * 3 a node, [k][rgb]
  // Of compact storage, what was restored: scales of sh, means, and what the file has of rotations
  // (runtime/math/shape_code.h), since restored ones may be told in two ways. Lossless: none.
  ShScales sh_scale{};
  MeanGrid mean_grid{};
  std::vector<MeanCode> mean_code;
  std::vector<std::array<uint16_t, 3>> rotation_code;
  std::vector<uint8_t> node_code;      // runtime/math/node_code.h
  std::vector<uint32_t> source_index;  // leaf: its index in the input; interior: kNoNode
  // Lossless storage: the input's own position words of leaves (world = cloud
  // origin + word), three a node; empty where they equal words.mean.
  std::vector<float> position_words;

  // i counts owned nodes.
  const NodeRecord& record_of(size_t i) const { return records[record[i]]; }
  bool is_leaf(size_t i) const { return record_of(i).child_count == 0; }
  bool has_logit(size_t i) const { return is_leaf(i) && !linear_leaves; }
};

}  // namespace voyager
