#include "plugin/depth_limit.h"

#include "plugin/plane.h"
#include "plugin/structs.h"

namespace voyager {
namespace {

// Within them 1/z and its slope are binary32 numbers.
constexpr double kLeastNear = 1e-18, kMostNear = 1e18;

DepthForm form_of(VoyDepthEncoding encoding) {
  switch (encoding) {
    case VOY_DEPTH_ENCODING_STANDARD:
      return DepthForm::standard;
    case VOY_DEPTH_ENCODING_REVERSED:
      return DepthForm::reversed;
    default:
      return DepthForm::metres;
  }
}

void check_planes(const VoyEyeDepthLimit& limit) {
  if (!(limit.nearZ >= kLeastNear && limit.nearZ <= kMostNear))
    refuse_number("VoyEyeDepthLimit.nearZ", limit.nearZ, "metres from 1e-18 to 1e18");
  if (!(limit.farZ > limit.nearZ))
    refuse_number("VoyEyeDepthLimit.farZ", limit.farZ, "metres beyond nearZ, or infinity");
}

}  // namespace

DepthLimits depth_limits(const VoyEyeDepthLimit* limit, const Image& image) {
  if (limit == nullptr) return {};
  check_pointer(limit->depth, "VoyEyeDepthLimit.depth");
  const size_t pitch =
      checked_pitch({"VoyEyeDepthLimit.depth", limit->depth, limit->depthRowPitch, 4u}, image.width,
                    image.height);
  check_enum(limit->encoding, VOY_DEPTH_ENCODING_REVERSED, "VoyEyeDepthLimit.encoding");
  check_count(limit->reserved, 0, 0, "VoyEyeDepthLimit.reserved");
  if (limit->encoding != VOY_DEPTH_ENCODING_METRES) check_planes(*limit);
  return {limit->depth, pitch, depth_encoding(form_of(limit->encoding), limit->nearZ, limit->farZ)};
}

}  // namespace voyager
