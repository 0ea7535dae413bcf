#pragma once
// XrSwapchain: images on the application's device, and whose turn each is.
#include <deque>
#include <vector>

#include "formats.h"
#include "session.h"

namespace test_runtime {

struct SwapchainImage {
  VkImage image = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  bool initialised = false;  // in the layout that OpenXR promises
  bool acquired = false;
};

struct Swapchain final : Object {
  Swapchain(Session& of, const XrSwapchainCreateInfo& info, const Format& format);
  ~Swapchain() override;

  VkImageLayout layout() const;  // between release and the next acquire
  VkImageAspectFlags aspect() const;
  uint32_t next_image();  // to hand out; refuses where none is free
  void initialise(SwapchainImage& image) const;

  Session& session;
  const XrSwapchainCreateInfo info;  // without its chain
  const Format& format;
  std::vector<SwapchainImage> images;
  std::deque<uint32_t> acquired;  // in order, oldest first
  bool waited = false;            // the oldest one
  int64_t last_released = -1;
  int64_t acquisitions = 0, releases = 0, used_release = 0;
  int64_t timed_out_at = -1;  // the frame whose scripted time-out was given

 private:
  void create_image(SwapchainImage& image) const;
  void destroy_images();
};

// A live one, refused once its session is lost.
Swapchain& find_swapchain(XrSwapchain handle);

}  // namespace test_runtime
