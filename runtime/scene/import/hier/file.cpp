#include "runtime/scene/import/hier/file.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "runtime/math/half.h"
#include "runtime/scene/import/refuse.h"

namespace voyager::hier {
namespace {

// ln of the smallest normal number: below what is drawn, so that it is counted as repaired.
constexpr float kLogOfNothing = -87.3f;

int32_t read_count(const ByteSource& source, uint64_t offset, const char* field) {
  if (source.size() < offset + sizeof(int32_t))
    refuse(source.name(), offset, field, "a file of " + std::to_string(source.size()) + " bytes",
           "at least " + std::to_string(offset + sizeof(int32_t)));
  int32_t count = 0;
  source.read(offset, std::as_writable_bytes(std::span(&count, 1)));
  return count;
}

template <class Row>
std::vector<Row> read_rows(const ByteSource& source, uint64_t start, uint64_t first, size_t count) {
  std::vector<Row> rows(count);
  source.read(start + first * sizeof(Row), std::as_writable_bytes(std::span(rows)));
  return rows;
}

struct HalfBox {
  uint16_t value[8];
};
static_assert(sizeof(HalfBox) == kHalfHierBoxBytes);

HierBox widened(const HalfBox& half) {
  float v[8];
  for (size_t i = 0; i < 8; ++i) v[i] = half_to_float(half.value[i]);
  return {{v[0], v[1], v[2]}, v[3], {v[4], v[5], v[6]}, v[7]};
}

}  // namespace

Rows::Rows(std::span<const std::byte> bytes, size_t count, bool half) : half_(half) {
  const size_t value = half ? 2 : 4;
  positions_ = bytes.data();
  rotations_ = positions_ + 12 * count;
  log_scales_ = rotations_ + 4 * value * count;
  opacities_ = log_scales_ + 3 * value * count;
  sh_ = opacities_ + value * count;
}

size_t Rows::bytes_of(size_t count, bool half) {
  const size_t values = 4 + 3 + 1 + kHierShFloats;
  return count * (12 + values * (half ? 2 : 4));
}

float Rows::value(const std::byte* array, size_t index) const {
  if (half_) {
    uint16_t word = 0;
    std::memcpy(&word, array + 2 * index, sizeof word);
    return half_to_float(word);
  }
  float word = 0;
  std::memcpy(&word, array + 4 * index, sizeof word);
  return word;
}

GaussianWords Rows::words(size_t i) const {
  GaussianWords words{};
  float mean[3];
  std::memcpy(mean, positions_ + 12 * i, sizeof mean);
  for (size_t axis = 0; axis < 3; ++axis) {
    words.mean[static_cast<int>(axis)] = mean[axis];
    const float log_scale = value(log_scales_, 3 * i + axis);
    words.log_scale[static_cast<int>(axis)] =
        log_scale == -std::numeric_limits<float>::infinity() ? kLogOfNothing : log_scale;
  }
  words.rotation = {value(rotations_, 4 * i), value(rotations_, 4 * i + 1),
                    value(rotations_, 4 * i + 2), value(rotations_, 4 * i + 3)};
  words.opacity = std::fabs(value(opacities_, i));
  return words;
}

void Rows::copy_sh(size_t i, float* to) const {
  for (size_t k = 0; k < kHierShFloats; ++k) to[k] = value(sh_, kHierShFloats * i + k);
}

void Rows::copy_all(size_t i, float* to) const {
  std::memcpy(to, positions_ + 12 * i, 3 * sizeof(float));
  for (size_t k = 0; k < 4; ++k) to[3 + k] = value(rotations_, 4 * i + k);
  for (size_t k = 0; k < 3; ++k) to[7 + k] = value(log_scales_, 3 * i + k);
  to[10] = value(opacities_, i);
  copy_sh(i, to + 11);
}

File::File(std::shared_ptr<const ByteSource> source) : source_(std::move(source)) {
  const int64_t told = read_count(*source_, 0, "Gaussian count");
  half_ = told < 0;
  const uint64_t count = static_cast<uint64_t>(std::abs(told));
  const HierLayout empty(count, 0, half_);
  const int32_t nodes = read_count(*source_, empty.node_count, "node count");
  if (nodes < 0) refuse(name(), empty.node_count, "node count", std::to_string(nodes), "0 or more");
  layout_ = HierLayout(count, static_cast<uint64_t>(nodes), half_);
  if (source_->size() != layout_.end)
    refuse(name(), empty.node_count, "node count",
           std::to_string(nodes) + " in a file of " + std::to_string(source_->size()) + " bytes",
           "a file of " + std::to_string(layout_.end));
  if (nodes == 0 && count != 0)
    refuse(name(), empty.node_count, "node count",
           "0 nodes of " + std::to_string(count) + " Gaussians", "at least 1");
  gaussians_ = static_cast<uint32_t>(count);
  nodes_ = static_cast<uint32_t>(nodes);
}

uint64_t File::offset_of_node(uint64_t node) const {
  return layout_.nodes + node * (half_ ? sizeof(HalfHierNode) : sizeof(HierNode));
}

uint64_t File::offset_of_box(uint64_t node) const {
  return layout_.boxes + node * (half_ ? kHalfHierBoxBytes : sizeof(HierBox));
}

std::vector<std::byte> File::read_gaussians(uint64_t first, size_t count) const {
  std::vector<std::byte> bytes(Rows::bytes_of(count, half_));
  std::span<std::byte> rest(bytes);
  const auto take = [&](uint64_t start, size_t width) {
    source_->read(start + first * width, rest.first(count * width));
    rest = rest.subspan(count * width);
  };
  const auto value = static_cast<size_t>(layout_.value);
  take(layout_.positions, 12);
  take(layout_.rotations, 4 * value);
  take(layout_.log_scales, 3 * value);
  take(layout_.opacities, value);
  take(layout_.sh, kHierShFloats * value);
  return bytes;
}

std::vector<HierNode> File::read_nodes(uint64_t first, size_t count) const {
  if (!half_) return read_rows<HierNode>(*source_, layout_.nodes, first, count);
  std::vector<HierNode> nodes;
  nodes.reserve(count);
  for (const HalfHierNode& n : read_rows<HalfHierNode>(*source_, layout_.nodes, first, count))
    nodes.push_back({n.depth, n.parent, n.start, n.count_leafs, n.count_merged, n.start_children,
                     n.count_children});
  return nodes;
}

std::vector<HierBox> File::read_boxes(uint64_t first, size_t count) const {
  if (!half_) return read_rows<HierBox>(*source_, layout_.boxes, first, count);
  std::vector<HierBox> boxes;
  boxes.reserve(count);
  for (const HalfBox& box : read_rows<HalfBox>(*source_, layout_.boxes, first, count))
    boxes.push_back(widened(box));
  return boxes;
}

}  // namespace voyager::hier
