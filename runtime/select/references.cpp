#include "runtime/select/references.h"

#include <cmath>
#include <limits>

namespace voyager {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::infinity();

// Never below the value; a NaN (∞ − ∞) is unknown.
float rounded_up(double value) {
  const auto rounded = static_cast<float>(value);
  if (!(rounded <= std::numeric_limits<float>::max())) return kUnknown;
  return rounded == 0.0f && value == 0.0 ? 0.0f : std::nextafter(rounded, kUnknown);
}

double distance(const Vec3f& a, const Vec3f& b) {
  const double x = double{a.x} - b.x, y = double{a.y} - b.y, z = double{a.z} - b.z;
  return std::sqrt((x * x + y * y) + z * z);
}

Travel travel_between(const CutQuery& a, const CutQuery& b) {
  return {rounded_up(distance(a.centre, b.centre)),
          rounded_up(
              std::fabs(inverse_target_size(a.target_size) - inverse_target_size(b.target_size)))};
}

}  // namespace

void References::begin_frame(const CutQuery& query) {
  const CutQuery& last = references_[current_];
  const bool moved = used_ == 0 || !(query == last);
  retired_ = {kUnknown, kUnknown};
  const bool takes_over = moved && used_ == kReferences;
  if (moved) {
    current_ = used_ == 0 ? 0 : (current_ + 1) % kReferences;
    if (takes_over)
      retired_ = travel_between(query, references_[current_]);
    else
      ++used_;
    references_[current_] = query;
  }
  for (uint32_t i = 0; i < used_; ++i) travel_[i] = travel_between(query, references_[i]);
  if (takes_over) travel_[current_] = {kUnknown, kUnknown};
}

}  // namespace voyager
