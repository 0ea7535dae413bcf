// Entry points that need no object.
#include <cmath>

#include "plugin/call.h"
#include "plugin/frustum.h"
#include "plugin/structs.h"
#include "runtime/frame/backend.h"

using namespace voyager;

namespace {

// The header may not be ahead of the project.
static_assert(VOY_API_VERSION <= VOY_MAKE_VERSION(VOYAGER_VERSION_MAJOR, VOYAGER_VERSION_MINOR,
                                                  VOYAGER_VERSION_PATCH));

constexpr double kHalfPi = 1.57079632679489661923;

double angle_tangent(double radians, const char* name) {
  if (!(std::fabs(radians) < kHalfPi))
    refuse_number(name, radians, "an angle between -pi/2 and pi/2, in radians");
  return std::tan(radians);
}

void check_finite(double value, const char* name) {
  if (!std::isfinite(value)) refuse_number(name, value, "a finite number");
}

void check_positive(double value, const char* name) {
  check_finite(value, name);
  if (value <= 0) refuse_number(name, value, "more than 0");
}

}  // namespace

uint32_t VOY_CALL voyGetVersion(void) {
  return VOY_MAKE_VERSION(VOYAGER_VERSION_MAJOR, VOYAGER_VERSION_MINOR, VOYAGER_VERSION_PATCH);
}

const char* VOY_CALL voyResultName(VoyResult result) {
  switch (number(result)) {
#define VOYAGER_NAME(enumerant) \
  case enumerant:               \
    return #enumerant
    VOYAGER_NAME(VOY_SUCCESS);
    VOYAGER_NAME(VOY_INCOMPLETE);
    VOYAGER_NAME(VOY_ERROR_INVALID_ARGUMENT);
    VOYAGER_NAME(VOY_ERROR_INVALID_HANDLE);
    VOYAGER_NAME(VOY_ERROR_INVALID_STRUCTURE);
    VOYAGER_NAME(VOY_ERROR_INCOMPATIBLE_VERSION);
    VOYAGER_NAME(VOY_ERROR_UNSUPPORTED);
    VOYAGER_NAME(VOY_ERROR_OUT_OF_HOST_MEMORY);
    VOYAGER_NAME(VOY_ERROR_OVER_BUDGET);
    VOYAGER_NAME(VOY_ERROR_FILE_NOT_FOUND);
    VOYAGER_NAME(VOY_ERROR_IO);
    VOYAGER_NAME(VOY_ERROR_REFUSED_INPUT);
    VOYAGER_NAME(VOY_ERROR_DAMAGED_CHUNK);
    VOYAGER_NAME(VOY_ERROR_NO_DEVICE);
    VOYAGER_NAME(VOY_ERROR_BUSY);
    VOYAGER_NAME(VOY_ERROR_SCENE_CLOSED);
    VOYAGER_NAME(VOY_ERROR_INTERNAL);
    VOYAGER_NAME(VOY_ERROR_DEVICE_LOST);
    VOYAGER_NAME(VOY_ERROR_TIMEOUT);
#undef VOYAGER_NAME
    default:
      return "unknown VoyResult";
  }
}

const char* VOY_CALL voyGetLastErrorMessage(void) {
  return last_message();
}

const char* VOY_CALL voyStageName(VoyStage stage) {
  static_assert(int{VOY_STAGE_SEARCH} == kSearch && int{VOY_STAGE_PROJECT} == kProject &&
                int{VOY_STAGE_SORT} == kSort && int{VOY_STAGE_BIN} == kBin &&
                int{VOY_STAGE_RASTERIZE} == kRasterize && int{VOY_STAGE_RESOLVE} == kResolve);
  const auto index = static_cast<uint32_t>(number(stage));
  return index < kStageCount ? kStageNames[index] : nullptr;
}

VoyResult VOY_CALL voyFrustumFromAngles(double left, double right, double up, double down,
                                        VoyFrustum* frustum) {
  return guarded("voyFrustumFromAngles", [&](Call&) {
    check_pointer(frustum, "frustum");
    const VoyFrustum tangents = {angle_tangent(left, "left"), angle_tangent(right, "right"),
                                 angle_tangent(up, "up"), angle_tangent(down, "down")};
    check_frustum(tangents, "frustum");
    *frustum = tangents;
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyFrustumFromIntrinsics(double fx, double fy, double cx, double cy,
                                            double width, double height, VoyFrustum* frustum) {
  return guarded("voyFrustumFromIntrinsics", [&](Call&) {
    check_pointer(frustum, "frustum");
    check_positive(fx, "fx");
    check_positive(fy, "fy");
    check_finite(cx, "cx");
    check_finite(cy, "cy");
    check_positive(width, "width");
    check_positive(height, "height");
    const VoyFrustum tangents = {-cx / fx, (width - cx) / fx, cy / fy, (cy - height) / fy};
    check_frustum(tangents, "frustum");
    *frustum = tangents;
    return VOY_SUCCESS;
  });
}
