// That the silence of the other tests says something: the layer is there, and sees hazards.
#include "frames.h"

namespace validation_test {
namespace {

// Two submissions write one buffer, and nothing orders them.
TEST_F(Interop, ValidationSeesAHazardBetweenSubmissions) {
  if (!host->validates()) VOYAGER_SKIP_WITHOUT(VULKAN, "no VK_LAYER_KHRONOS_validation");
  const MappedBuffer buffer(*host, 4096);
  const VkFence fences[] = {host->make_fence(), host->make_fence()};
  for (uint32_t i = 0; i < 2; ++i) {
    VkCommandBuffer commands = host->begin();
    vkCmdFillBuffer(commands, buffer.buffer, 0, 4096, i);
    host->submit(commands, {}, {}, fences[i]);
  }
  for (const VkFence fence : fences) {
    host->wait_for(fence);
    vkDestroyFence(host->device, fence, nullptr);
  }
  ASSERT_FALSE(host->messages.text.empty());
  EXPECT_NE(host->messages.text[0].find("SYNC-HAZARD-WRITE-AFTER-WRITE"), std::string::npos)
      << host->messages.text[0];
  host->messages.text.clear();
}

}  // namespace
}  // namespace validation_test
