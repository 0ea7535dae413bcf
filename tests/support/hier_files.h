#pragma once
// .hier files for tests, as HierarchicalGS's tools write them: nodes depth-first, the children of
// one beside each other.
#include <algorithm>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "runtime/math/half.h"
#include "runtime/scene/hier_format.h"
#include "tests/support/sealed.h"

namespace voyager::test {

struct HierSample {
  std::vector<float> positions, rotations, log_scales, opacities, sh;
  std::vector<HierNode> nodes;
  std::vector<HierBox> boxes;
};

inline void add_hier_gaussian(HierSample& sample, std::mt19937& random) {
  const auto number = [&](float least, float most) {
    return std::uniform_real_distribution<float>(least, most)(random);
  };
  for (int i = 0; i < 3; ++i) sample.positions.push_back(number(-9, 9));
  for (int i = 0; i < 4; ++i) sample.rotations.push_back(number(-3, 3));  // of any length
  for (int i = 0; i < 3; ++i) sample.log_scales.push_back(number(-8, 1));
  sample.opacities.push_back(number(0, 1.5f));  // also of leaves
  for (size_t i = 0; i < kHierShFloats; ++i) sample.sh.push_back(number(-1, 1));
}

// What a merged file has: a root of infinite extent with several Gaussians, an inner node without
// children (node 4), rotations of any length, and nodes in another order than breadth-first.
inline HierSample merged_hier() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  HierSample s;
  //          depth parent start leafs merged children
  s.nodes = {{3, -1, 0, 0, 2, 1, 2},    // 0
             {2, 0, 2, 0, 1, 3, 2},     // 1
             {1, 0, 7, 0, 1, 7, 3},     // 2
             {1, 1, 3, 0, 1, 5, 2},     // 3
             {1, 1, 6, 0, 1, 7, 0},     // 4
             {0, 3, 4, 1, 0, 7, 0},     // 5
             {0, 3, 5, 1, 0, 7, 0},     // 6
             {0, 2, 8, 1, 0, 10, 0},    // 7
             {0, 2, 9, 1, 0, 10, 0},    // 8
             {0, 2, 10, 1, 0, 10, 0}};  // 9
  const float extents[] = {kInfinity, 16, 7, 4, 3, 0, 0, 0, 0, 0};
  const float reach[] = {20, 16, 14, 12, 8, 4, 4, 2, 2, 2};
  for (size_t n = 0; n < s.nodes.size(); ++n)
    s.boxes.push_back(
        {{-reach[n], -reach[n] / 2, -1}, extents[n], {reach[n], reach[n] / 4, 1}, extents[n]});
  std::mt19937 random(7);
  for (int i = 0; i < 11; ++i) add_hier_gaussian(s, random);
  return s;
}

// Two roots under one that has a Gaussian of each, in the order of an export: nodes breadth-first,
// Gaussians in the order of nodes. Node 1 has two further ones, of which one is not finite, and so
// has node 4, which has no children.
inline HierSample merged_roots_hier() {
  HierSample s;
  s.nodes = {{3, -1, 0, 0, 2, 1, 2},   // 0
             {2, 0, 2, 0, 3, 3, 2},    // 1
             {1, 0, 5, 0, 1, 5, 2},    // 2
             {1, 1, 6, 0, 1, 7, 2},    // 3
             {1, 1, 7, 0, 3, 0, 0},    // 4
             {0, 2, 10, 1, 0, 0, 0},   // 5
             {0, 2, 11, 1, 0, 0, 0},   // 6
             {0, 3, 12, 1, 0, 0, 0},   // 7
             {0, 3, 13, 1, 0, 0, 0}};  // 8
  const float extents[] = {std::numeric_limits<float>::infinity(), 16, 7, 4, 3, 0, 0, 0, 0};
  const float reach[] = {20, 16, 14, 12, 8, 4, 4, 2, 2};
  for (size_t n = 0; n < s.nodes.size(); ++n)
    s.boxes.push_back({{-reach[n], -1, -1}, extents[n], {reach[n], 1, 1}, extents[n]});
  std::mt19937 random(9);
  for (int i = 0; i < 14; ++i) add_hier_gaussian(s, random);
  s.opacities[3] = -0.5f;
  s.positions[3 * 4] = std::numeric_limits<float>::infinity();
  return s;
}

// A node of one leaf. What random bytes do to a file is soon tried at all of its places.
inline HierSample small_hier() {
  HierSample s;
  s.nodes = {{1, -1, 0, 0, 1, 1, 2}, {0, 0, 1, 1, 0, 3, 0}, {0, 0, 2, 1, 0, 3, 0}};
  s.boxes = {{{-4, -4, -4}, 8, {4, 4, 4}, 8},
             {{-4, -4, -4}, 0, {0, 0, 0}, 0},
             {{0, 0, 0}, 0, {4, 4, 4}, 0}};
  std::mt19937 random(8);
  for (int i = 0; i < 3; ++i) add_hier_gaussian(s, random);
  return s;
}

class HierWriter {
 public:
  explicit HierWriter(bool half) : half_(half) {}

  void put(int32_t value) { put_bytes(&value, sizeof value); }
  void put(const HierNode& n) {
    if (!half_) return put_bytes(&n, sizeof n);
    const HalfHierNode half{n.parent,
                            n.start,
                            n.start_children,
                            static_cast<int16_t>(n.depth),
                            static_cast<int16_t>(n.count_children),
                            static_cast<int16_t>(n.count_leafs),
                            static_cast<int16_t>(n.count_merged)};
    put_bytes(&half, sizeof half);
  }
  void put_positions(const std::vector<float>& values) {
    put_bytes(values.data(), values.size() * sizeof(float));
  }
  void put_number(float value) {
    if (!half_) return put_bytes(&value, sizeof value);
    const uint16_t half = std::isinf(value) ? 0x7c00 : float_to_half(value);
    put_bytes(&half, sizeof half);
  }
  void put_numbers(const std::vector<float>& values) {
    for (const float value : values) put_number(value);
  }
  Bytes bytes;

 private:
  void put_bytes(const void* data, size_t size) {
    const auto* first = static_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), first, first + size);
  }
  bool half_;
};

inline Bytes hier_bytes(const HierSample& s, bool half = false) {
  HierWriter out(half);
  const auto gaussians = static_cast<int32_t>(s.opacities.size());
  out.put(half ? -gaussians : gaussians);
  out.put_positions(s.positions);
  out.put_numbers(s.rotations);
  out.put_numbers(s.log_scales);
  out.put_numbers(s.opacities);
  out.put_numbers(s.sh);
  out.put(static_cast<int32_t>(s.nodes.size()));
  for (const HierNode& node : s.nodes) out.put(node);
  for (const HierBox& box : s.boxes)
    for (const float v : {box.min.x, box.min.y, box.min.z, box.size, box.max.x, box.max.y,
                          box.max.z, box.size_again})
      out.put_number(v);
  return std::move(out.bytes);
}

}  // namespace voyager::test
