#pragma once
#include "resources.h"

namespace host {

// Copies an image, which is in TRANSFER_SRC_OPTIMAL, to where the host can read it once the
// commands are done.
void copy_to_host(VkCommandBuffer commands, VkImage from, VkImageAspectFlags aspect,
                  VkExtent2D extent, const Buffer& into);

}  // namespace host
