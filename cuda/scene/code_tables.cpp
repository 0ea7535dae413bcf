#include "cuda/scene/code_tables.h"

#include "runtime/frame/scene_gaussians.h"

namespace voyager::cuda {
namespace {

Buffer<float> copy_of(const float* values, size_t count) {
  return upload(std::span<const float>(values, count));
}

}  // namespace

CodeTables::CodeTables()
    : scale_(copy_of(shape_tables().scale, kScaleCodes)),
      leaf_opacity_(copy_of(shape_tables().leaf_opacity, kOpacityCodes)),
      log_opacity_(copy_of(shape_tables().log_opacity, 2 * kOpacityCodes)) {}

ShapeTables CodeTables::view() const {
  return {scale_.data(), leaf_opacity_.data(), log_opacity_.data()};
}

}  // namespace voyager::cuda
