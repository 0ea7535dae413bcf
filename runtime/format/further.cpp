#include "runtime/format/further.h"

#include <algorithm>

#include "runtime/scene/hier_format.h"

namespace voyager {
namespace {

constexpr size_t kBlock = 4096;           // Gaussians read at a time
constexpr uint64_t kNodeBlock = 1 << 16;  // nodes

constexpr uint64_t kGaussianBytes = kHierFloats * sizeof(float);

}  // namespace

void write_further(AtomicFile& file, const FurtherGaussians& further) {
  const uint32_t counts[] = {static_cast<uint32_t>(further.nodes.size()),
                             static_cast<uint32_t>(further.words.size() / kHierFloats)};
  RunningChecksum sum;
  const auto write = [&](std::span<const std::byte> part) {
    sum.add(part);
    file.write(part);
  };
  write(std::as_bytes(std::span(counts)));
  write(std::as_bytes(std::span(further.nodes)));
  write(std::as_bytes(std::span(further.words)));
  const uint64_t value = sum.value();
  file.write(std::as_bytes(std::span(&value, 1)));
}

FurtherReader::FurtherReader(const SceneFile& scene)
    : scene_(scene), check_(scene.source()), at_(scene.info().further_offset) {
  if (at_ == 0) return;
  const uint64_t begin = at_, length = scene.source().size() - begin;
  uint32_t counts[2];
  read(std::as_writable_bytes(std::span(counts)));
  check_.that(counts[0] >= 1 && counts[0] <= scene.info().node_count, begin,
              "a count of nodes with further Gaussians out of range",
              "1 to the number of the file's nodes");
  check_.equal(begin, "length of the further Gaussians", length,
               sizeof counts + counts[0] * sizeof(FurtherCount) + counts[1] * kGaussianBytes +
                   sizeof(uint64_t));
  gaussians_ = left_ = counts[1];
  read_nodes(counts[0]);
}

void FurtherReader::read(std::span<std::byte> bytes) {
  scene_.source().read(at_, bytes);
  sum_.add(bytes);
  at_ += bytes.size();
}

void FurtherReader::read_nodes(uint32_t count) {
  uint64_t gaussians = 0;
  while (nodes_.size() < count) {
    const uint64_t begin = at_;
    const size_t had = nodes_.size();
    nodes_.resize(had + std::min<uint64_t>(kNodeBlock, count - had));
    read(std::as_writable_bytes(std::span(nodes_).subspan(had)));
    for (size_t i = had; i < nodes_.size(); ++i) {
      const uint64_t at = begin + (i - had) * sizeof(FurtherCount);
      check_.at_most(at, "node", nodes_[i].node, scene_.info().node_count - 1);
      check_.that(i == 0 || nodes_[i].node > nodes_[i - 1].node, at,
                  "a node that is not after the one before", "ascending nodes");
      check_.that(nodes_[i].count != 0, at, "a node with 0 further Gaussians", "at least 1");
      gaussians += nodes_[i].count;
    }
  }
  check_.equal(scene_.info().further_offset, "further Gaussians of all nodes", gaussians,
               gaussians_);
}

std::span<const float> FurtherReader::next(size_t most) {
  if (taken_ == block_.size()) {
    block_.resize(kHierFloats * std::min<uint64_t>(kBlock, left_));
    read(std::as_writable_bytes(std::span(block_)));
    left_ -= block_.size() / kHierFloats;
    taken_ = 0;
  }
  const size_t count = std::min(kHierFloats * most, block_.size() - taken_);
  taken_ += count;
  return std::span<const float>(block_).subspan(taken_ - count, count);
}

void FurtherReader::finish() {
  if (scene_.info().further_offset == 0) return;
  uint64_t told;
  const uint64_t found = sum_.value();
  scene_.source().read(at_, std::as_writable_bytes(std::span(&told, 1)));
  check_.equal(at_, "checksum of the further Gaussians", found, told);
}

}  // namespace voyager
