#pragma once
// A picture from memory that the screen can show.
#include <span>

#include "device.h"
#include "resources.h"

namespace voyager::view {

class StillImage {
 public:
  // rgba: 8 bits a channel, code values. Waits until the device has it.
  StillImage(const host::Device& device, VkExtent2D extent, std::span<const uint8_t> rgba);
  VkImageView view() const { return view_.get(); }

 private:
  host::Image image_;
  host::UniqueImageView view_;  // a 2D array
};

}  // namespace voyager::view
