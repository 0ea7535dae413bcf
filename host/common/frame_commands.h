#pragma once
// The commands of the frames in flight. Each frame has two command buffers: "before" hands Voyager
// its image, and "after" takes it back. What the order of a frame is, voyager_ring.h says.
#include <array>

#include "frames_in_flight.h"
#include "gpu.h"
#include "submission.h"
#include "unique.h"

namespace host {

class FrameCommands {
 public:
  explicit FrameCommands(const Gpu& gpu);
  // Waits for the device: frames may be in flight where an error ends the program.
  ~FrameCommands();
  FrameCommands(const FrameCommands&) = delete;
  FrameCommands& operator=(const FrameCommands&) = delete;

  // The slot of the next frame, once the frame before it there is done.
  uint32_t wait_for_slot() const;
  // Of the next frame, once its slot was waited for. They are begun, and submitted with what they
  // wait for and signal.
  VkCommandBuffer begin_before() const;
  VkCommandBuffer begin_after() const;
  // Ends and submits them. host_waits: until they are done (VOY_VULKAN_SYNC_HOST).
  void submit_before(const Submission& submission, bool host_waits);
  // The frame is done with: the next one has the next slot.
  void submit_after(const Submission& submission);

 private:
  struct Slot {
    VkCommandBuffer before = VK_NULL_HANDLE, after = VK_NULL_HANDLE;
    UniqueFence before_done, after_done;
  };

  const Gpu gpu_;
  UniqueCommandPool pool_;
  std::array<Slot, kFramesInFlight> slots_;
  uint32_t slot_ = 0;
};

}  // namespace host
