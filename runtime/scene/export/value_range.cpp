#include "runtime/scene/export/value_range.h"

#include <algorithm>
#include <bit>

namespace voyager {
namespace {

struct Reach {
  float least_log_scale, most_log_scale, f_dc, sh;
};

// The largest absolute value. Compared as integers, because compilers then vectorise the loop.
float farthest(std::span<const float> values) {
  int32_t most = 0;
  for (const float value : values) most = std::max(most, std::bit_cast<int32_t>(value) & INT32_MAX);
  return std::bit_cast<float>(most);
}

Reach reach_of(const GaussianCloud& batch, size_t i) {
  const size_t floats = static_cast<size_t>(batch.coefficients()) * 3;
  const auto scale = std::span(batch.log_scale).subspan(3 * i, 3);
  const auto [least, most] = std::minmax({scale[0], scale[1], scale[2]});
  const auto sh = std::span(batch.sh).subspan(floats * i, floats);
  return {least, most, farthest(sh.first(3)), farthest(sh.subspan(3))};
}

bool holds(const ValueRange& range, const Reach& reach) {
  return reach.least_log_scale >= range.least_log_scale &&
         reach.most_log_scale <= range.most_log_scale && reach.f_dc <= range.most_f_dc &&
         reach.sh <= range.most_sh;
}

}  // namespace

std::vector<uint64_t> count_outside(std::span<const ValueRange> ranges,
                                    const GaussianCloud& batch) {
  std::vector<uint64_t> counts(ranges.size());
  for (size_t i = 0; i < batch.size(); ++i) {
    const Reach reach = reach_of(batch, i);
    for (size_t k = 0; k < ranges.size(); ++k) counts[k] += !holds(ranges[k], reach);
  }
  return counts;
}

}  // namespace voyager
