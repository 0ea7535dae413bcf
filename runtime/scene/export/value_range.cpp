#include "runtime/scene/export/value_range.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace voyager {
namespace {

float farthest(std::span<const float> values) {
  float most = 0;
  for (const float value : values) most = std::max(most, std::fabs(value));
  return most;
}

}  // namespace

uint64_t count_outside(const ValueRange& range, const GaussianCloud& batch) {
  const size_t floats = static_cast<size_t>(batch.coefficients()) * 3;
  uint64_t count = 0;
  for (size_t i = 0; i < batch.size(); ++i) {
    const auto scale = std::span(batch.log_scale).subspan(3 * i, 3);
    const auto [least, most] = std::minmax({scale[0], scale[1], scale[2]});
    const auto sh = std::span(batch.sh).subspan(floats * i, floats);
    count += least < range.least_log_scale || most > range.most_log_scale ||
             farthest(sh.first(3)) > range.most_f_dc || farthest(sh.subspan(3)) > range.most_sh;
  }
  return count;
}

}  // namespace voyager
