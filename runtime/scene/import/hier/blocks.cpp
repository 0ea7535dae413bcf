// The leaves of a .hier as a flat scene, in the order of the file's Gaussians.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/hier/tree.h"

namespace voyager::hier {
namespace {

constexpr size_t kMostRows = 65536;  // Gaussians of a block, merged ones between leaves included

float logit_of(float opacity) {
  return std::isnan(opacity) ? opacity : flat_logit(opacity);
}

class Reader final : public BlockReader {
 public:
  explicit Reader(std::shared_ptr<const ByteSource> source)
      : file_(std::move(source)), leaves_(leaf_gaussians(read_tree(file_))) {}

  const std::string& name() const override { return file_.name(); }
  uint64_t count() const override { return leaves_.size(); }
  int sh_degree() const override { return 3; }
  NativeScale native() const override { return {}; }

  // A block: how many rows, which of them are leaves, and the rows.
  RawBlock next(size_t most) override {
    RawBlock block;
    if (taken_ == leaves_.size()) return block;
    const uint32_t first = leaves_[taken_];
    std::vector<uint32_t> words(1);
    while (block.count < most && taken_ < leaves_.size() && leaves_[taken_] - first < kMostRows) {
      words.push_back(leaves_[taken_++] - first);
      ++block.count;
    }
    words[0] = words.back() + 1;
    const auto head = std::as_bytes(std::span(words));
    const std::vector<std::byte> rows = file_.read_gaussians(first, words[0]);
    block.bytes.assign(head.begin(), head.end());
    block.bytes.insert(block.bytes.end(), rows.begin(), rows.end());
    return block;
  }

  GaussianCloud decode(const RawBlock& block) const override {
    std::vector<uint32_t> words(1 + block.count);
    std::memcpy(words.data(), block.bytes.data(), words.size() * sizeof(uint32_t));
    const Rows rows(std::span(block.bytes).subspan(words.size() * sizeof(uint32_t)), words[0],
                    file_.half());
    GaussianCloud cloud;
    cloud.sh_degree = 3;
    cloud.sh.resize(kHierShFloats * block.count);
    for (size_t i = 0; i < block.count; ++i) {
      const GaussianWords g = rows.words(words[1 + i]);
      cloud.position.insert(cloud.position.end(), {g.mean.x, g.mean.y, g.mean.z});
      cloud.log_scale.insert(cloud.log_scale.end(), {g.log_scale.x, g.log_scale.y, g.log_scale.z});
      cloud.rotation.insert(cloud.rotation.end(),
                            {g.rotation.w, g.rotation.x, g.rotation.y, g.rotation.z});
      cloud.opacity.push_back(logit_of(g.opacity));
      rows.copy_sh(words[1 + i], &cloud.sh[kHierShFloats * i]);
    }
    return cloud;
  }

 private:
  File file_;
  std::vector<uint32_t> leaves_;
  size_t taken_ = 0;
};

}  // namespace
}  // namespace voyager::hier

namespace voyager {

std::unique_ptr<BlockReader> open_hier_blocks(std::shared_ptr<const ByteSource> source) {
  return std::make_unique<hier::Reader>(std::move(source));
}

}  // namespace voyager
