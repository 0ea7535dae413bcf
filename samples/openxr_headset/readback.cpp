#include "readback.h"

#include "image_copy.h"

namespace host {
namespace {

constexpr VkFormat kEncoded = VK_FORMAT_R8G8B8A8_SRGB;

struct Use {
  VkImageLayout layout;
  VkAccessFlags access;
  VkPipelineStageFlags stages;
};
constexpr Use kNew = {VK_IMAGE_LAYOUT_UNDEFINED, 0, VK_PIPELINE_STAGE_TRANSFER_BIT};
constexpr Use kAttachment = {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                             VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                             VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT};
constexpr Use kCopiedFrom = {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_ACCESS_TRANSFER_READ_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT};
constexpr Use kCopiedTo = {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_ACCESS_TRANSFER_WRITE_BIT,
                           VK_PIPELINE_STAGE_TRANSFER_BIT};

void change(VkCommandBuffer commands, VkImage image, uint32_t layer, const Use& from,
            const Use& to) {
  const VkImageMemoryBarrier barrier = {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                        nullptr,
                                        from.access,
                                        to.access,
                                        from.layout,
                                        to.layout,
                                        VK_QUEUE_FAMILY_IGNORED,
                                        VK_QUEUE_FAMILY_IGNORED,
                                        image,
                                        {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, layer, 1}};
  vkCmdPipelineBarrier(commands, from.stages, to.stages, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

void blit(VkCommandBuffer commands, const EyeImage& from, VkImage to) {
  const VkOffset3D corner = {static_cast<int32_t>(from.extent.width),
                             static_cast<int32_t>(from.extent.height), 1};
  const VkImageBlit region = {{VK_IMAGE_ASPECT_COLOR_BIT, 0, from.layer, 1},
                              {{0, 0, 0}, corner},
                              {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                              {{0, 0, 0}, corner}};
  vkCmdBlitImage(commands, from.colour->image(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_NEAREST);
}

}  // namespace

Readback::Readback(const Graphics& graphics, const EyeImages& images)
    : views_(images.view_count()) {
  const ColourFormat format = images.colour_format();
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(graphics.physical(), format.format, &properties);
  if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_BLIT_SRC_BIT))
    throw Failure(kMachine, std::string("--readback: found ") + format.name +
                                ", which this device cannot blit from, expected one that it can");
  for (size_t i = 0; i < views_.size(); ++i) {
    const VkExtent2D extent = images.view(i).extent;
    views_[i].extent = extent;
    views_[i].encoded = Image(graphics, extent, kEncoded,
                              VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                              VK_IMAGE_ASPECT_COLOR_BIT);
    views_[i].buffer = Buffer(graphics, VkDeviceSize{4} * extent.width * extent.height,
                              VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  }
}

void Readback::record(VkCommandBuffer commands, const EyeImages& images) const {
  for (size_t i = 0; i < views_.size(); ++i) {
    const EyeImage& from = images.view(i);
    const VkImage encoded = views_[i].encoded.image.get();
    change(commands, from.colour->image(), from.layer, kAttachment, kCopiedFrom);
    change(commands, encoded, 0, kNew, kCopiedTo);
    blit(commands, from, encoded);
    change(commands, from.colour->image(), from.layer, kCopiedFrom, kAttachment);
    change(commands, encoded, 0, kCopiedTo, kCopiedFrom);
    copy_to_host(commands, encoded, VK_IMAGE_ASPECT_COLOR_BIT, views_[i].extent, views_[i].buffer);
  }
}

std::span<const uint8_t> Readback::rgba(size_t view) const {
  const Buffer& buffer = views_[view].buffer;
  return {reinterpret_cast<const uint8_t*>(buffer.mapped), buffer.size};
}

}  // namespace host
