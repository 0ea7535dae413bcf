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

}  // namespace

DepthEncoding checked_encoding(const VoyDepthEncoding& encoding, double near_z, double far_z,
                               const FieldName& name) {
  check_enum(encoding, VOY_DEPTH_ENCODING_REVERSED, name + ".depthEncoding");
  if (encoding == VOY_DEPTH_ENCODING_METERS) return {};
  if (!(near_z >= kLeastNear && near_z <= kMostNear))
    refuse_number(name + ".nearZ", near_z, "metres from 1e-18 to 1e18");
  if (!(far_z > near_z)) refuse_number(name + ".farZ", far_z, "metres beyond nearZ, or infinity");
  return depth_encoding(form_of(encoding), near_z, far_z);
}

DepthLimits depth_limits(const VoyEyeDepthLimit* limit, const Image& image,
                         const vulkan::Ring* ring, const FieldName& eye) {
  if (limit == nullptr) return {};
  const FieldName name = eye + ".next", depth = name + ".depth";
  check_count(limit->reserved, 0, 0, name + ".reserved");
  const DepthEncoding encoding =
      checked_encoding(limit->depthEncoding, limit->nearZ, limit->farZ, name);
  if (limit->depth == nullptr && ring != nullptr && ring->desc().depth_limit) {
    check_count(limit->depthRowPitch, 0, 0, name + ".depthRowPitch");
    return {nullptr, 0, encoding};
  }
  if (limit->depth == nullptr && ring != nullptr)
    refuse(depth.str() +
           ": found NULL for a target without VoyVulkanTargetDesc.hasDepthLimit, "
           "expected a target with it");
  check_pointer(limit->depth, depth);
  if (ring != nullptr && ring->device().sharing() == vulkan::Sharing::device)
    throw ApiError(VOY_ERROR_UNSUPPORTED,
                   depth.str() +
                       ": found host memory with DEVICE sharing, expected NULL and "
                       "voyRecordVulkanDepthLimit");
  const size_t pitch =
      checked_pitch({depth, limit->depth, limit->depthRowPitch, 4u}, image.width, image.height);
  return {limit->depth, pitch, encoding};
}

}  // namespace voyager
