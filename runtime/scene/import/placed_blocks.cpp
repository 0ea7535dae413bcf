#include "runtime/scene/import/placed_blocks.h"

#include "runtime/scene/transform.h"

namespace voyager {
namespace {

class PlacedReader final : public BlockReader {
 public:
  PlacedReader(std::unique_ptr<BlockReader> reader, const CloudTransform& transform,
               const std::array<double, 3>& origin)
      : reader_(std::move(reader)), transform_(transform), origin_(origin) {}

  const std::string& name() const override { return reader_->name(); }
  uint64_t count() const override { return reader_->count(); }
  int sh_degree() const override { return reader_->sh_degree(); }
  NativeScale native() const override { return transform_.of(reader_->native()); }
  std::array<double, 3> origin() const override { return origin_; }
  RawBlock next(size_t most) override { return reader_->next(most); }

  GaussianCloud decode(const RawBlock& block) const override {
    GaussianCloud cloud = reader_->decode(block);
    transform_.apply(cloud, origin_);
    return cloud;
  }

 private:
  std::unique_ptr<BlockReader> reader_;
  CloudTransform transform_;
  std::array<double, 3> origin_;
};

}  // namespace

std::unique_ptr<BlockReader> place_blocks(std::unique_ptr<BlockReader> reader, const Affine& place,
                                          const std::array<double, 3>& origin,
                                          const std::string& what) {
  return std::make_unique<PlacedReader>(std::move(reader), CloudTransform(place, what), origin);
}

}  // namespace voyager
