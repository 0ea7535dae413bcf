#pragma once
// One command buffer's submission, with semaphores of either kind.
#include <vulkan/vulkan.h>

#include <functional>
#include <vector>

namespace host {

// What a submission waits for or signals.
struct SemaphoreUse {
  VkSemaphore semaphore = VK_NULL_HANDLE;  // NULL: nothing
  uint64_t value = 0;                      // of a timeline semaphore, above 0; else 0
};

class Submission {
 public:
  explicit Submission(VkCommandBuffer commands) : commands_(commands) {}
  // Nothing, where the semaphore is NULL.
  void wait(const SemaphoreUse& use, VkPipelineStageFlags at);
  void signal(const SemaphoreUse& use);
  void submit(VkQueue queue, VkFence fence) const;

 private:
  struct Semaphores {
    std::vector<VkSemaphore> semaphores;
    std::vector<uint64_t> values;
  };
  bool add(Semaphores& list, const SemaphoreUse& use);

  VkCommandBuffer commands_;
  Semaphores waits_, signals_;
  std::vector<VkPipelineStageFlags> stages_;
  bool timelines_ = false;
};

// Records commands, submits them and waits until the queue is idle.
void run_once(VkDevice device, VkQueue queue, uint32_t queue_family,
              const std::function<void(VkCommandBuffer)>& record);

}  // namespace host
