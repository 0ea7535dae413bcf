#pragma once
// A .hier: its counts, checked against its length, and its arrays a part at a time.
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/math/gaussian.h"
#include "runtime/scene/hier_format.h"

namespace voyager::hier {

// Consecutive Gaussians as the file has them: one array after the other.
class Rows {
 public:
  // `bytes` is what File::read_gaussians() gave for `count` of them; it outlives the object.
  Rows(std::span<const std::byte> bytes, size_t count, bool half);

  static size_t bytes_of(size_t count, bool half);

  // The opacity is linear and not negative: HierarchicalGS draws its magnitude. A log scale of
  // -inf, of a scale of 0, becomes that of the smallest normal number.
  GaussianWords words(size_t i) const;
  // kHierShFloats of them.
  void copy_sh(size_t i, float* to) const;
  // All kHierFloats, nothing mended.
  void copy_all(size_t i, float* to) const;

 private:
  float value(const std::byte* array, size_t index) const;

  const std::byte *positions_, *rotations_, *log_scales_, *opacities_, *sh_;
  bool half_;
};

class File {
 public:
  // Throws Error(refused_input) where the counts do not make the file's length.
  explicit File(std::shared_ptr<const ByteSource> source);

  const std::string& name() const { return source_->name(); }
  bool half() const { return half_; }
  uint32_t gaussians() const { return gaussians_; }
  uint32_t nodes() const { return nodes_; }
  // Where a node is told, for messages.
  uint64_t offset_of_node(uint64_t node) const;
  uint64_t offset_of_box(uint64_t node) const;
  uint64_t offset_of_gaussian(uint64_t gaussian) const { return layout_.positions + 12 * gaussian; }

  // Of [first, first + count), which are there. Safe from several threads.
  std::vector<std::byte> read_gaussians(uint64_t first, size_t count) const;
  std::vector<HierNode> read_nodes(uint64_t first, size_t count) const;
  std::vector<HierBox> read_boxes(uint64_t first, size_t count) const;

 private:
  std::shared_ptr<const ByteSource> source_;
  bool half_ = false;
  uint32_t gaussians_ = 0, nodes_ = 0;
  HierLayout layout_{0, 0};
};

}  // namespace voyager::hier
