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

// Not below the exact sum, where the step was rounded.
double sum_up(double way, double step) {
  return std::nextafter(way + step * (1 + 0x1p-48), std::numeric_limits<double>::infinity());
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
  if (moved) {
    if (used_ != 0) journey_.way = sum_up(journey_.way, distance(query.centre, last.centre));
    journey_.turns += used_ == 0 || query.target_size != last.target_size;
    ++journey_.moves;
  }
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
