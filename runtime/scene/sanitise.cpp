#include "runtime/scene/sanitise.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

namespace voyager {
namespace {

using Values = std::span<float>;

Values row(std::pmr::vector<float>& values, size_t i, size_t width) {
  return Values(values).subspan(i * width, width);
}

// Without a branch for each, so that it is done on several at a time.
bool all_finite(Values values) {
  constexpr uint32_t kExponent = 0x7f800000;
  uint32_t infinite = 0;
  for (const float v : values)
    infinite |= uint32_t{(std::bit_cast<uint32_t>(v) & kExponent) == kExponent};
  return infinite == 0;
}

bool keeps(GaussianCloud& cloud, size_t i) {
  const Values position = row(cloud.position, i, 3);
  const auto in_range = [](float v) { return std::fabs(v) < kMaxCoordinate; };  // false for NaN
  if (!std::all_of(position.begin(), position.end(), in_range)) {
    ++cloud.report.dropped_position;
    return false;
  }
  if (!all_finite(row(cloud.log_scale, i, 3))) {
    ++cloud.report.dropped_scale;
    return false;
  }
  if (std::isnan(cloud.opacity[i])) {
    ++cloud.report.dropped_opacity;
    return false;
  }
  return true;
}

void repair_scale(Values log_scale, ImportReport& report) {
  bool repaired = false;
  for (float& s : log_scale) {
    const float clamped = std::clamp(s, kMinLogScale, kMaxLogScale);
    repaired = repaired || clamped != s;
    s = clamped;
  }
  report.repaired_scale += repaired;
}

void repair_rotation(Values q, ImportReport& report) {
  const bool zero = std::all_of(q.begin(), q.end(), [](float v) { return v == 0.0f; });
  if (!zero && all_finite(q)) return;
  q[0] = 1.0f;
  q[1] = q[2] = q[3] = 0.0f;
  ++report.repaired_rotation;
}

void repair_sh(Values sh, ImportReport& report) {
  if (all_finite(sh)) return;
  for (float& coefficient : sh)
    if (!std::isfinite(coefficient)) coefficient = 0.0f;
  ++report.repaired_sh;
}

void repair(GaussianCloud& cloud, size_t i, size_t sh_width) {
  ImportReport& report = cloud.report;
  repair_scale(row(cloud.log_scale, i, 3), report);
  repair_rotation(row(cloud.rotation, i, 4), report);
  if (std::isinf(cloud.opacity[i])) {
    cloud.opacity[i] = std::copysign(kMaxLogit, cloud.opacity[i]);
    ++report.repaired_opacity;
  }
  repair_sh(row(cloud.sh, i, sh_width), report);
}

void move_row(std::pmr::vector<float>& values, size_t from, size_t to, size_t width) {
  const Values source = row(values, from, width);
  std::copy(source.begin(), source.end(), row(values, to, width).begin());
}

}  // namespace

void sanitise(GaussianCloud& cloud) {
  const size_t count = cloud.size();
  const size_t sh_width = static_cast<size_t>(cloud.coefficients()) * 3;
  cloud.report.read = count;
  size_t kept = 0;
  for (size_t i = 0; i < count; ++i) {
    if (!keeps(cloud, i)) continue;
    repair(cloud, i, sh_width);
    if (kept != i) {
      move_row(cloud.position, i, kept, 3);
      move_row(cloud.log_scale, i, kept, 3);
      move_row(cloud.rotation, i, kept, 4);
      move_row(cloud.opacity, i, kept, 1);
      move_row(cloud.sh, i, kept, sh_width);
    }
    ++kept;
  }
  cloud.position.resize(3 * kept);
  cloud.log_scale.resize(3 * kept);
  cloud.rotation.resize(4 * kept);
  cloud.opacity.resize(kept);
  cloud.sh.resize(sh_width * kept);
}

}  // namespace voyager
