#pragma once
// The images that Voyager draws into, and the two timeline semaphores that order Voyager and
// Unity's queue. Unity submits its command buffers itself, so the semaphores get submissions of
// their own, which hold no commands: a signal covers all that was submitted before it, and a wait
// holds back all that is submitted after it. A frame:
//   1. next_frame(), voyRenderFrame, then drawn()
//   2. queue_signals() through IUnityGraphicsVulkan::AccessQueue, which flushes Unity's commands
//   3. in Unity's command buffer: record_acquire(), the composite, record_release()
#include <voyager/voyager_vulkan.h>

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <voyager/voyager.hpp>

#include "device_functions.h"

namespace voyager_unity {

// What AccessQueue's callback submits. It lives until the callback has run.
struct QueueSignals {
  PFN_vkQueueSubmit queue_submit;
  VkQueue queue;
  VkSemaphore released, rendered;
  uint64_t released_value, rendered_value;  // 0: no signal, no wait
  std::shared_ptr<std::atomic<uint64_t>> submitted;

  // Takes over `signals`, a QueueSignals*. On the thread that Unity submits on.
  static void submit(int event, void* signals);
};

class SplatImages {
 public:
  // Throws voy::Error. `functions` must outlive it.
  SplatImages(const DeviceFunctions& functions, const voy::Device& device, VkExtent2D extent,
              uint32_t queue_family);

  VoyTarget target() const { return target_.get(); }
  VkExtent2D extent() const { return extent_; }

  // The hand-over of all images to Voyager, once, before the first frame.
  void record_first_release(VkCommandBuffer commands);
  // The image to draw into; nothing while Unity has not submitted the commands that used it last.
  std::optional<VoyVulkanFrame> next_frame() const;
  void drawn() { ++frames_; }
  // For all that was recorded and drawn since the last call. The callback owns it.
  std::unique_ptr<QueueSignals> queue_signals(VkQueue queue);
  // Of the image that was drawn last. In the fragment shader it is sampled from then on.
  uint32_t record_acquire(VkCommandBuffer commands);
  void record_release(VkCommandBuffer commands, uint32_t image);

 private:
  static constexpr uint32_t kImages = 3;  // what Unity has in flight, and one more
  VoyVulkanUse use(VkCommandBuffer commands, uint32_t image) const;

  const DeviceFunctions& functions_;
  VkExtent2D extent_;
  uint32_t queue_family_;
  voy::Target target_;
  VkSemaphore released_semaphore_ = VK_NULL_HANDLE, rendered_semaphore_ = VK_NULL_HANDLE;
  std::array<uint64_t, kImages> released_at_ = {};  // values of released_semaphore_
  uint64_t signals_ = 0;                            // of released_semaphore_, given to AccessQueue
  bool released_since_ = false;                     // recorded, not yet signalled
  uint64_t frames_ = 0, waits_ = 0;                 // values of rendered_semaphore_
  std::shared_ptr<std::atomic<uint64_t>> submitted_ = std::make_shared<std::atomic<uint64_t>>(0);
};

}  // namespace voyager_unity
