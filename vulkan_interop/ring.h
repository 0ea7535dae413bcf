#pragma once
// A target's images: shared with the backend, or filled from staging memory; the semaphores
// around each frame; and the commands that the host has recorded.
#include <atomic>
#include <functional>
#include <memory>
#include <memory_resource>
#include <optional>
#include <vector>

#include "runtime/frame/image.h"
#include "runtime/math/host_depth.h"
#include "vulkan_interop/ring_descriptors.h"
#include "vulkan_interop/staging.h"

namespace voyager::vulkan {

// What the host says of its use of an image (VoyVulkanUse).
struct Use {
  VkCommandBuffer commands = VK_NULL_HANDLE;
  uint32_t queue_family = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL;
  VkPipelineStageFlags stages = 0;
};
struct CopyTo {
  VkCommandBuffer commands = VK_NULL_HANDLE;
  VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL;  // of the ring's image
  VkImage image = VK_NULL_HANDLE;
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkImageLayout image_layout = VK_IMAGE_LAYOUT_GENERAL;
  uint32_t layer = 0;
  VkOffset2D offset{0, 0};
};
struct LimitFrom {
  VkCommandBuffer commands = VK_NULL_HANDLE;
  uint32_t queue_family = 0;
  VkImage depth = VK_NULL_HANDLE;
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL;
  uint32_t layer = 0;
  VkOffset2D offset{0, 0};
};

// What a frame waits for and signals (VoyVulkanFrame).
struct FrameSync {
  uint64_t wait_value = 0, signal_value = 0;
};

struct RingImage {
  VkImage color = VK_NULL_HANDLE, depth = VK_NULL_HANDLE;
  VkImageView color_view = VK_NULL_HANDLE, depth_view = VK_NULL_HANDLE;
  VkSemaphore released = VK_NULL_HANDLE, rendered = VK_NULL_HANDLE;
};

class Ring {
 public:
  // The backend's side of a device that shares images.
  using ImportRing = std::function<std::unique_ptr<ExternalRing>(ExternalRingDesc)>;

  // Takes copies of the imported descriptors. Throws Error; nothing remains then.
  Ring(std::shared_ptr<const Device> device, const RingDesc& desc, const ImportRing& import,
       std::pmr::memory_resource* memory);
  // Waits for the backend; a timeline that the host left is signalled after a while, so that
  // nothing hangs.
  ~Ring();

  const Device& device() const { return *device_; }
  const RingDesc& desc() const { return desc_; }
  RingImage image(uint32_t index) const;
  VkDescriptorSet descriptors(uint32_t index) const { return descriptors_.of(index); }

  // Where the frame is drawn. Throws Error(invalid_argument) for values that the mode does
  // not have, and for an image that the host did not release; Error(timeout),
  // Error(device_lost).
  Image begin_frame(uint32_t index, uint32_t layer, const FrameSync& sync);
  // Where the host's depth is, if it is in host memory.
  void set_limits(uint32_t index, uint32_t layer, DepthLimits& limits) const;
  // After a frame that was drawn, or is in flight.
  void end_frame(const FrameSync& sync);
  // The backend's frames are done, or will be without the host.
  // False where they do not end within a few times the patience: a lost device, say.
  bool finish() noexcept;
  // The ring goes without a wait, and leaves what frames may still write to.
  void abandon() noexcept { abandoned_ = true; }

  // Throw Error(invalid_argument), and record nothing, for a layout or a family that cannot be
  // the image's, stages that read no image, or an image that is not there to be taken.
  void record_release(uint32_t index, const Use& use);
  void record_acquire(uint32_t index, const Use& use);
  void record_copy(uint32_t index, uint32_t layer, const CopyTo& to) const;
  void record_depth_limit(uint32_t index, uint32_t layer, const LimitFrom& from) const;

 private:
  // Who may use an image: the host takes it by an acquire, and gives it by a release.
  enum class Holder { nobody_yet, voyager, host };
  struct Slot {
    ImageResource color, depth;  // none where the host passed its own
    RingImage image;
    Owned<VkImageView> color_view, depth_view;
    BufferResource depth_limit;  // of a ring that is shared
    Holder holder = Holder::nobody_yet;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  // that the host acquired it in
    VkPipelineStageFlags last_stages = 0;
  };
  struct Semaphores {
    Owned<VkSemaphore> released, rendered;
  };

  bool shared() const { return device_->sharing() == Sharing::device; }
  void check_imported() const;
  void make_slot(uint32_t index);
  void make_semaphores();
  void make_views(uint32_t index);
  void share(const ImportRing& import);
  ExternalSlot external_slot(uint32_t index) const;
  void check_values(const FrameSync& sync) const;
  void check_released(uint32_t index, const char* field) const;
  void check_family(uint32_t family) const;
  void wait_for_host(const FrameSync& sync) const;
  // Whether `released` has what frames wait for: a timeline must not be signalled twice.
  bool release_in_the_hosts_stead() const noexcept;
  void transition(const Slot& slot, VkCommandBuffer commands, VkPipelineStageFlags from,
                  VkPipelineStageFlags to, VkImageMemoryBarrier barrier) const;
  void copy_from_staging(uint32_t index, const Use& use) const;

  std::shared_ptr<const Device> device_;
  RingDesc desc_;
  std::vector<Semaphores> semaphores_;
  std::vector<Slot> slots_;
  RingDescriptors descriptors_;
  std::optional<Staging> staging_;
  std::unique_ptr<ExternalRing> external_;
  bool abandoned_ = false;
  uint64_t last_signal_ = 0;
  std::atomic<uint64_t> last_wait_{0};  // finish() may run beside a frame
};

}  // namespace voyager::vulkan
