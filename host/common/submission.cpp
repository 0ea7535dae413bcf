#include "submission.h"

#include "failure.h"
#include "unique.h"

namespace host {

bool Submission::add(Semaphores& list, const SemaphoreUse& use) {
  if (!use.semaphore) return false;
  list.semaphores.push_back(use.semaphore);
  list.values.push_back(use.value);
  timelines_ |= use.value > 0;
  return true;
}

void Submission::wait(const SemaphoreUse& use, VkPipelineStageFlags at) {
  if (add(waits_, use)) stages_.push_back(at);
}

void Submission::signal(const SemaphoreUse& use) {
  add(signals_, use);
}

void Submission::submit(VkQueue queue, VkFence fence) const {
  VkTimelineSemaphoreSubmitInfo values = {};
  values.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO;
  values.waitSemaphoreValueCount = static_cast<uint32_t>(waits_.values.size());
  values.pWaitSemaphoreValues = waits_.values.data();
  values.signalSemaphoreValueCount = static_cast<uint32_t>(signals_.values.size());
  values.pSignalSemaphoreValues = signals_.values.data();
  VkSubmitInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  if (timelines_) info.pNext = &values;  // binary semaphores' values are ignored
  info.waitSemaphoreCount = static_cast<uint32_t>(waits_.semaphores.size());
  info.pWaitSemaphores = waits_.semaphores.data();
  info.pWaitDstStageMask = stages_.data();
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands_;
  info.signalSemaphoreCount = static_cast<uint32_t>(signals_.semaphores.size());
  info.pSignalSemaphores = signals_.semaphores.data();
  check(vkQueueSubmit(queue, 1, &info, fence), "vkQueueSubmit");
}

void run_once(VkDevice device, VkQueue queue, uint32_t queue_family,
              const std::function<void(VkCommandBuffer)>& record) {
  const VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0,
                                             queue_family};
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vkCreateCommandPool(device, &pool_info, nullptr, &pool), "vkCreateCommandPool");
  const UniqueCommandPool owner(device, pool);
  const VkCommandBufferAllocateInfo info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr,
                                            pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vkAllocateCommandBuffers(device, &info, &commands), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin = {};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  record(commands);
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  Submission(commands).submit(queue, VK_NULL_HANDLE);
  check(vkQueueWaitIdle(queue), "vkQueueWaitIdle");
}

}  // namespace host
