#pragma once
// Node records in compact storage: exact, but as differences from what most
// nodes have, so that their bytes are mostly zeros.
#include <algorithm>
#include <bit>
#include <cstdint>

#include "runtime/format/fold.h"
#include "runtime/lod/tree.h"
#include "runtime/lod/tree_rule.h"
#include "runtime/math/float_bits.h"

namespace voyager {

// The words of one box, in the order of the file's planes.
struct BoxWords {
  uint32_t word[6];
};

// What y or z of a box's far corner would be, were it a cube, as a leaf's is.
inline float cube_side(const NodeRecord& r, int axis) {
  return r.box_min[axis] + (r.box_max.x - r.box_min.x);
}

// Of a box that no other tells.
inline BoxWords box_words(const NodeRecord& r) {
  return {{float_bits(r.box_min.x), float_bits(r.box_min.y), float_bits(r.box_min.z),
           float_bits(r.box_max.x), fold(float_bits(r.box_max.y) - float_bits(cube_side(r, 1))),
           fold(float_bits(r.box_max.z) - float_bits(cube_side(r, 2)))}};
}
inline void set_box(const BoxWords& w, NodeRecord& r) {
  r.box_min = {std::bit_cast<float>(w.word[0]), std::bit_cast<float>(w.word[1]),
               std::bit_cast<float>(w.word[2])};
  r.box_max.x = std::bit_cast<float>(w.word[3]);
  r.box_max.y = std::bit_cast<float>(unfold(w.word[4]) + float_bits(cube_side(r, 1)));
  r.box_max.z = std::bit_cast<float>(unfold(w.word[5]) + float_bits(cube_side(r, 2)));
}

// Of one that the boxes of all of the node's children tell: it is their hull. count is not 0.
inline NodeRecord hull_of_boxes(const NodeRecord* children, uint32_t count) {
  NodeRecord hull = children[0];
  for (uint32_t i = 1; i < count; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      hull.box_min[axis] = std::min(hull.box_min[axis], children[i].box_min[axis]);
      hull.box_max[axis] = std::max(hull.box_max[axis], children[i].box_max[axis]);
    }
  return hull;
}
inline BoxWords box_words(const NodeRecord& r, const NodeRecord& hull) {
  BoxWords words{};
  for (int axis = 0; axis < 3; ++axis) {
    words.word[axis] = fold(float_bits(r.box_min[axis]) - float_bits(hull.box_min[axis]));
    words.word[3 + axis] = fold(float_bits(r.box_max[axis]) - float_bits(hull.box_max[axis]));
  }
  return words;
}
inline void set_box(const BoxWords& w, const NodeRecord& hull, NodeRecord& r) {
  for (int axis = 0; axis < 3; ++axis) {
    r.box_min[axis] = std::bit_cast<float>(unfold(w.word[axis]) + float_bits(hull.box_min[axis]));
    r.box_max[axis] =
        std::bit_cast<float>(unfold(w.word[3 + axis]) + float_bits(hull.box_max[axis]));
  }
}

// No parent: nullptr.
inline float usual_extent(ExtentRule rule, const NodeRecord& r, const NodeRecord* parent) {
  switch (rule) {
    case ExtentRule::error:
      return 0.0f;
    case ExtentRule::error_with_doubles:
      return r.child_count <= 1 && parent ? kLateShare * parent->extent : 0.0f;
    case ExtentRule::longest_side:
      break;
  }
  if (r.child_count == 0) return 0.0f;
  return std::max(
      {r.box_max.x - r.box_min.x, r.box_max.y - r.box_min.y, r.box_max.z - r.box_min.z});
}
inline uint32_t extent_word(ExtentRule rule, const NodeRecord& r, const NodeRecord* parent) {
  return fold(float_bits(r.extent) - float_bits(usual_extent(rule, r, parent)));
}
// The rest of the record is set.
inline float extent_of_word(uint32_t word, ExtentRule rule, const NodeRecord& r,
                            const NodeRecord* parent) {
  return std::bit_cast<float>(unfold(word) + float_bits(usual_extent(rule, r, parent)));
}

}  // namespace voyager
