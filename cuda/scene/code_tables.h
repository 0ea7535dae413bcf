#pragma once
// What coded scenes are restored with (runtime/math/shape_code.h), in a device's memory.
#include "cuda/device/buffer.h"
#include "cuda/scene/gaussian_view.h"

namespace voyager::cuda {

// Less than 1 MB, the same for all scenes: Device::code_tables() shares it.
class CodeTables {
 public:
  static constexpr size_t kBytes = (kScaleCodes + 3 * kOpacityCodes) * sizeof(float);

  CodeTables();

  ShapeTables view() const;

 private:
  Buffer<float> scale_, leaf_opacity_, log_opacity_;
};

}  // namespace voyager::cuda
