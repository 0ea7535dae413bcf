#pragma once
// Node records in compact storage: exact, but as differences from what most
// nodes have, so that their bytes are mostly zeros. A leaf's box is a cube; of
// hierarchicalgs trees an extent is the longest side of its box, 0 for a leaf.
#include <algorithm>
#include <bit>
#include <cstdint>

#include "runtime/format/fold.h"
#include "runtime/lod/tree.h"

namespace voyager {

// The words of one record, in the order of the file's planes.
struct RecordWords {
  uint32_t word[8];
};

inline uint32_t float_bits(float value) {
  return std::bit_cast<uint32_t>(value);
}

// What y or z of the box's far corner would be, were it as wide as in x.
inline float cube_side(const NodeRecord& r, int axis) {
  return r.box_min[axis] + (r.box_max.x - r.box_min.x);
}

inline float usual_extent(const NodeRecord& r) {
  if (r.child_count == 0) return 0.0f;
  return std::max(
      {r.box_max.x - r.box_min.x, r.box_max.y - r.box_min.y, r.box_max.z - r.box_min.z});
}

inline RecordWords to_words(const NodeRecord& r) {
  return {{float_bits(r.box_min.x), float_bits(r.box_min.y), float_bits(r.box_min.z),
           float_bits(r.box_max.x), fold(float_bits(r.box_max.y) - float_bits(cube_side(r, 1))),
           fold(float_bits(r.box_max.z) - float_bits(cube_side(r, 2))), r.child_count,
           fold(float_bits(r.extent) - float_bits(usual_extent(r)))}};
}

inline NodeRecord from_words(const RecordWords& w) {
  NodeRecord r{};
  r.box_min = {std::bit_cast<float>(w.word[0]), std::bit_cast<float>(w.word[1]),
               std::bit_cast<float>(w.word[2])};
  r.box_max.x = std::bit_cast<float>(w.word[3]);
  r.box_max.y = std::bit_cast<float>(unfold(w.word[4]) + float_bits(cube_side(r, 1)));
  r.box_max.z = std::bit_cast<float>(unfold(w.word[5]) + float_bits(cube_side(r, 2)));
  r.child_count = w.word[6];
  r.extent = std::bit_cast<float>(unfold(w.word[7]) + float_bits(usual_extent(r)));
  return r;
}

}  // namespace voyager
