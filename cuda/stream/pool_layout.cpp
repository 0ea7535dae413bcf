#include "cuda/stream/pool_layout.h"

#include "runtime/frame/scene_gaussians.h"

namespace voyager::cuda {
namespace {

constexpr size_t kAlign = 256;

size_t aligned(size_t bytes) {
  return (bytes + kAlign - 1) / kAlign * kAlign;
}

}  // namespace

ShForm sh_form(const Scene& scene) {
  if (is_coded(scene)) return ShForm::coded;
  return scene.largest_sh <= kMaxHalfCoefficient ? ShForm::half : ShForm::single;
}

bool owners_in_shapes(const Scene& scene, SlotShape shape) {
  return is_coded(scene) && owner_code_bytes(shape.nodes) == 1;
}

PoolLayout::PoolLayout(const Scene& scene, SlotShape shape, PoolRoom room) {
  const ShForm form = sh_form(scene);
  const bool coded = form == ShForm::coded;
  unit_ = {hull_bytes(form),
           shape_bytes(form),
           coefficient_bytes(scene.sh_degree, form),
           scene.search.leaves_have_extent ? sizeof(NodeRecord) : 0,
           coded ? 0 : sizeof(float),
           owners_in_shapes(scene, shape) ? 0 : owner_code_bytes(shape.nodes),
           coded ? 0 : sizeof(uint32_t),
           coded ? 0 : sizeof(uint8_t),
           sizeof(SearchRecord),
           sizeof(uint32_t),
           coded ? sizeof(ShStepSizes) : 0,
           coded ? sizeof(MeanGrid) : 0,
           sizeof(uint32_t),
           sizeof(SearchSubtree),
           sizeof(uint32_t),
           sizeof(SearchChunk),
           sizeof(uint32_t),
           sizeof(LargeFamily),
           sizeof(uint32_t)};
  fixed_bytes_ = {};
  fixed_bytes_[kPages] = pages_of(scene.search.subtree_count()) * unit_[kPages];
  if (coded) fixed_bytes_[kLargeFamilyCount] = unit_[kLargeFamilyCount];
  family_bytes_ = coded ? unit_[kLargeFamilies] : 0;
  block_bytes_ = {};
  block_bytes_[kRecords] = kRecordBlock * unit_[kRecords];
  block_bytes_[kNextBlocks] = unit_[kNextBlocks];
  page_bytes_ = {};
  for (const PoolArray a : {kSubtrees, kOutside}) {
    page_bytes_[a] = kPageSubtrees * unit_[a];
    fixed_bytes_[a] = page_bytes_[a];  // of the page that stands for all that has no place
  }
  for (uint32_t a = 0; a < kPoolArrays; ++a) {
    const bool filled = a < kFilledArrays && block_bytes_[a] == 0;
    slot_bytes_[a] = (!filled ? 0 : counted_by(a) == kOnce ? 1 : shape.nodes) * unit_[a];
  }
  slot_bytes_[kChunks] = unit_[kChunks];
  set_room(room);
}

void PoolLayout::set_room(PoolRoom room) {
  begin_[0] = 0;
  for (uint32_t a = 0; a < kPoolArrays; ++a) {
    const uint64_t families = a == kLargeFamilies ? room.families * family_bytes_ : 0;
    begin_[a + 1] =
        begin_[a] + aligned(room.slots * slot_bytes_[a] + room.blocks * block_bytes_[a] +
                            room.pages * page_bytes_[a] + families + fixed_bytes_[a]);
  }
}

PoolBytes PoolLayout::pool_bytes() const {
  PoolBytes bytes{0, 0, kPoolArrays * kAlign, 0, family_bytes_};
  for (uint32_t a = 0; a < kPoolArrays; ++a) {
    bytes.slot += slot_bytes_[a];
    bytes.block += block_bytes_[a];
    bytes.page += page_bytes_[a];
    bytes.fixed += fixed_bytes_[a];
  }
  return bytes;
}

}  // namespace voyager::cuda
