#pragma once
// One command buffer's submission, with semaphores of either kind.
#include "voyager_layer.h"

namespace host {

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

}  // namespace host
