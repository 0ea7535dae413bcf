#include "runtime/scene/import/placed_blocks.h"

#include "runtime/scene/import/forwarded_blocks.h"
#include "runtime/scene/transform.h"

namespace voyager {
namespace {

class PlacedReader final : public ForwardedBlocks {
 public:
  PlacedReader(std::unique_ptr<BlockReader> reader, const CloudTransform& transform,
               const std::array<double, 3>& origin)
      : ForwardedBlocks(std::move(reader)), transform_(transform), origin_(origin) {}

  NativeScale native() const override { return transform_.of(ForwardedBlocks::native()); }
  std::array<double, 3> origin() const override { return origin_; }
  GaussianCloud decode(const RawBlock& block) const override {
    GaussianCloud cloud = ForwardedBlocks::decode(block);
    transform_.apply(cloud, origin_);
    return cloud;
  }

 private:
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
