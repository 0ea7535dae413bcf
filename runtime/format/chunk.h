#pragma once
// One chunk in memory: contiguous nodes of the breadth-first order, with the
// words of their Gaussians (compact storage: dequantised to the same words).
#include <cstdint>
#include <vector>

#include "runtime/lod/tree.h"
#include "runtime/math/gaussian.h"

namespace voyager {

struct Chunk {
  uint32_t first_node = 0;
  uint32_t first_child = 0;  // id of the first child of the chunk's first interior node
  std::vector<NodeRecord> records;
  std::vector<GaussianWords> words;  // scene-local means; leaf opacity is a logit, merged linear
  std::vector<float> sh;             // coefficients * 3 a node, [k][rgb]
  std::vector<uint8_t> axis_code;
  std::vector<uint32_t> source_index;  // leaf: its index in the input; interior: kNoNode
  // Lossless storage: the input's own position words of leaves (world = cloud
  // origin + word), three a node; empty where they equal words.mean.
  std::vector<float> position_words;
};

}  // namespace voyager
