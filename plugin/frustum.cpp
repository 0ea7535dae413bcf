#include "plugin/frustum.h"

#include <cmath>

#include "plugin/structs.h"

namespace voyager {
namespace {

// ±89.994 degrees, and a span that a float64 focal length resolves.
constexpr double kMaxTangent = 1e4, kMinSpan = 1e-6;

void check_tangent(double tangent, const FieldName& field) {
  if (!(std::fabs(tangent) <= kMaxTangent))
    refuse_number(field, tangent, "a tangent between -1e4 and 1e4");
}

void check_span(double low, double high, const FieldName& field, const char* other) {
  if (!(high - low >= kMinSpan))
    refuse_number(field, low, std::string("at least 1e-6 less than ") + other);
}

}  // namespace

void check_frustum(const VoyFrustum& frustum, const FieldName& name) {
  check_tangent(frustum.left, name + ".left");
  check_tangent(frustum.right, name + ".right");
  check_tangent(frustum.up, name + ".up");
  check_tangent(frustum.down, name + ".down");
  check_span(frustum.left, frustum.right, name + ".left", "right");
  check_span(frustum.down, frustum.up, name + ".down", "up");
}

}  // namespace voyager
