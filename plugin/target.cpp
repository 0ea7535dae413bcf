#include <string>

#include "plugin/call.h"
#include "plugin/plane.h"
#include "plugin/structs.h"
#include "plugin/vulkan_target.h"

using namespace voyager;

ColorFormat voyager::format_of(VoyColorFormat format) {
  switch (format) {
    case VOY_COLOR_FORMAT_RGBA8_UNORM:
      return ColorFormat::rgba8;
    case VOY_COLOR_FORMAT_RGBA32F:
      return ColorFormat::rgba32f;
    case VOY_COLOR_FORMAT_RGBA16F:
      return ColorFormat::rgba16f;
    default:
      return ColorFormat::none;
  }
}

namespace {

Image checked_image(const VoyTargetDesc& desc) {
  const bool has_color = desc.colorFormat != VOY_COLOR_FORMAT_NONE;
  if (has_color != (desc.color != nullptr))
    refuse(has_color ? "desc.color: found NULL, expected memory for colorFormat"
                     : "desc.color: found a pointer, expected NULL for VOY_COLOR_FORMAT_NONE");
  if (!has_color && desc.depth == nullptr)
    refuse("desc: found neither color nor depth, expected at least one");

  Image image;
  image.width = desc.width;
  image.height = desc.height;
  if (has_color) {
    image.format = format_of(desc.colorFormat);
    image.color = desc.color;
    image.color_pitch =
        checked_pitch({"desc.color", desc.color, desc.colorRowPitch, pixel_bytes(image.format)},
                      desc.width, desc.height);
  }
  if (desc.depth != nullptr) {
    image.depth = desc.depth;
    image.depth_pitch =
        checked_pitch({"desc.depth", desc.depth, desc.depthRowPitch, 4u}, desc.width, desc.height);
  }
  return image;
}

}  // namespace

VoyResult VOY_CALL voyCreateTarget(VoyDevice device, const VoyTargetDesc* desc, VoyTarget* target) {
  return guarded("voyCreateTarget", [&](Call& call) {
    const auto owner = call.use<DeviceObject>(device);
    const VoyVulkanTargetDesc* images = nullptr;
    check_structure(desc, VOY_STRUCTURE_TYPE_TARGET_DESC, "VoyTargetDesc",
                    Extension{VOY_STRUCTURE_TYPE_VULKAN_TARGET_DESC, images});
    check_pointer(target, "target");
    check_enum(desc->kind, VOY_TARGET_KIND_VULKAN, "desc.kind");
    check_enum(desc->colorFormat, VOY_COLOR_FORMAT_RGBA16F, "desc.colorFormat");
    check_count(desc->width, 1, kMaxImageSide, "desc.width");
    check_count(desc->height, 1, kMaxImageSide, "desc.height");
    const bool vulkan = desc->kind == VOY_TARGET_KIND_VULKAN;
    if (!vulkan && images != nullptr)
      throw ApiError(VOY_ERROR_INVALID_STRUCTURE,
                     "desc.next: found a VoyVulkanTargetDesc, expected it with kind VULKAN only");
    std::vector<int> passed;
    const auto object = vulkan ? create_vulkan_target(owner, *desc, images, passed)
                               : std::make_shared<TargetObject>(owner, checked_image(*desc));
    *target = static_cast<VoyTarget>(HandleTable::instance().insert(object));
    close_all(passed);
    return VOY_SUCCESS;
  });
}

VoyResult VOY_CALL voyDestroyTarget(VoyTarget target) {
  return guarded("voyDestroyTarget", [&](Call& call) {
    call.remove<TargetObject>(target);
    return VOY_SUCCESS;
  });
}
