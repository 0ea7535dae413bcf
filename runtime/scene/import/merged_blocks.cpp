#include "runtime/scene/import/merged_blocks.h"

#include <algorithm>

#include "runtime/scene/append.h"
#include "runtime/scene/import/refuse.h"
#include "runtime/scene/sh_bands.h"

namespace voyager {
namespace {

class MergedReader final : public BlockReader {
 public:
  MergedReader(std::string name, std::vector<BlockPart> parts, const std::array<double, 3>& origin)
      : name_(std::move(name)), parts_(std::move(parts)), origin_(origin) {
    const std::array<double, 3> any{};
    for (const BlockPart& part : parts_) {
      if (__builtin_add_overflow(count_, part.count, &count_))
        refuse(name_, 0, "Gaussians", "2^64 or more", "fewer");
      sh_degree_ = std::max(sh_degree_, part.sh_degree);
      require_alike(any, parts_.front().native, any, part.native, name_);
    }
  }

  const std::string& name() const override { return name_; }
  uint64_t count() const override { return count_; }
  int sh_degree() const override { return sh_degree_; }
  NativeScale native() const override {
    return parts_.empty() ? NativeScale{} : parts_.front().native;
  }
  std::array<double, 3> origin() const override { return origin_; }

  RawBlock next(size_t most) override {
    for (;;) {
      if (current_) {
        RawBlock block = current_->next(most);
        const size_t count = block.count;
        if (count != 0)
          return {{}, count, current_, std::make_shared<const RawBlock>(std::move(block))};
      }
      if (next_ == parts_.size()) break;
      current_ = parts_[next_++].open();
    }
    current_ = nullptr;
    return {};
  }

  GaussianCloud decode(const RawBlock& block) const override {
    GaussianCloud cloud = block.part->decode(*block.of_part);
    change_sh_degree(cloud.sh, cloud.sh_degree, sh_degree_);
    cloud.sh_degree = sh_degree_;
    return cloud;
  }

 private:
  std::string name_;
  std::vector<BlockPart> parts_;
  std::array<double, 3> origin_;
  uint64_t count_ = 0;
  int sh_degree_ = 0;
  size_t next_ = 0;
  std::shared_ptr<BlockReader> current_;
};

}  // namespace

std::unique_ptr<BlockReader> merge_blocks(std::string name, std::vector<BlockPart> parts,
                                          const std::array<double, 3>& origin) {
  return std::make_unique<MergedReader>(std::move(name), std::move(parts), origin);
}

}  // namespace voyager
