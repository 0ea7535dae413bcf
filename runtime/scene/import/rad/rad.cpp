// Spark's .rad as a flat scene: all Gaussians, or the leaves of its tree, in the order of the file.
#include <algorithm>
#include <utility>

#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/merged_blocks.h"
#include "runtime/scene/import/rad/chunk.h"
#include "runtime/scene/import/rad/words.h"
#include "runtime/scene/import/refuse.h"

namespace voyager::rad {
namespace {

using Source = std::shared_ptr<const ByteSource>;

bool says_of_gaussians(const Property& property) {
  return property.kind < Kind::child_count;
}

// The Gaussians of a chunk. A block has planes as the chunk has them, for fewer Gaussians.
class ChunkReader final : public BlockReader {
 public:
  ChunkReader(Chunk chunk, const Header& header)
      : chunk_(std::move(chunk)), sh_degree_(header.sh_degree) {
    if (header.is_tree) leaves_ = leaves_of(chunk_);
    count_ = header.is_tree ? leaves_.size() : static_cast<size_t>(chunk_.count);
    for (const auto& property : chunk_.properties)
      if (property && says_of_gaussians(*property)) row_bytes_ += plain_bytes_of(*property);
    is_tree_ = header.is_tree;
  }

  const std::string& name() const override { return chunk_.source->name(); }
  uint64_t count() const override { return count_; }
  int sh_degree() const override { return sh_degree_; }
  NativeScale native() const override { return {}; }

  RawBlock next(size_t most) override {
    RawBlock block;
    if (taken_ == count_) return block;
    if (plain_.empty()) read();
    block.count = std::min({most, count_ - taken_, kMostBlockBytes / row_bytes_});
    block.bytes.reserve(block.count * row_bytes_);
    size_t at = 0;
    for (const auto& property : chunk_.properties)
      if (property && says_of_gaussians(*property))
        copy_rows(planes_of(*property), plain_[at++], block);
    taken_ += block.count;
    if (taken_ == count_) plain_.clear();
    return block;
  }

  GaussianCloud decode(const RawBlock& block) const override {
    GaussianCloud cloud;
    cloud.sh_degree = sh_degree_;
    cloud.position.resize(3 * block.count);
    cloud.log_scale.resize(3 * block.count);
    cloud.rotation.resize(4 * block.count);
    cloud.opacity.resize(block.count);
    cloud.sh.resize(static_cast<size_t>(cloud.coefficients()) * 3 * block.count);
    std::span<const std::byte> rest = block.bytes;
    for (const auto& property : chunk_.properties) {
      if (!property || !says_of_gaussians(*property)) continue;
      const size_t bytes = block.count * plain_bytes_of(*property);
      decode_property(*property, rest.first(bytes), cloud);
      rest = rest.subspan(bytes);
    }
    return cloud;
  }

 private:
  void read() {
    for (const auto& property : chunk_.properties)
      if (property && says_of_gaussians(*property)) plain_.push_back(read_plain(chunk_, *property));
  }

  // The next block.count elements of each plane.
  void copy_rows(Planes planes, const std::vector<std::byte>& from, RawBlock& block) const {
    const size_t element = planes.element_bytes;
    for (size_t plane = 0; plane < planes.count; ++plane) {
      const std::byte* begin = from.data() + plane * static_cast<size_t>(chunk_.count) * element;
      for (size_t i = taken_; i < taken_ + block.count; ++i) {
        const std::byte* row = begin + (is_tree_ ? leaves_[i] : i) * element;
        block.bytes.insert(block.bytes.end(), row, row + element);
      }
    }
  }

  Chunk chunk_;
  int sh_degree_;
  bool is_tree_ = false;
  std::vector<uint32_t> leaves_;  // of a tree
  size_t count_ = 0, taken_ = 0, row_bytes_ = 0;
  std::vector<std::vector<std::byte>> plain_;  // of each property, while there are Gaussians left
};

std::unique_ptr<BlockReader> open(const Source& source) {
  const auto file = std::make_shared<const File>(read_header(*source));
  const Header& header = file->header;
  std::vector<BlockPart> parts;
  for (const ChunkPlace& place : file->chunks) {
    BlockPart part{place.count, header.sh_degree, {}, {}};
    if (header.is_tree) part.count = leaves_of(open_chunk(source, header, place)).size();
    part.open = [source, file, &place] {
      return std::make_shared<ChunkReader>(open_chunk(source, file->header, place), file->header);
    };
    if (part.count > 0) parts.push_back(std::move(part));
  }
  if (parts.empty())
    refuse(source->name(), 0, "child_count", "none of 0", "a tree that has leaves");
  return merge_blocks(source->name(), std::move(parts), {});
}

}  // namespace
}  // namespace voyager::rad

namespace voyager {

// The table of formats has one signature for all.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
std::unique_ptr<BlockReader> open_rad_blocks(std::shared_ptr<const ByteSource> source) {
  return rad::open(source);
}

}  // namespace voyager
