// What it costs a device to go from Vulkan's work to CUDA's and back: the floor of any hand-off
// between the two, with nothing handed over.
//
//   turns_bench
//
// A line for each length of CUDA's work (one thread that spins), milliseconds a turn: CUDA by
// itself; an empty submission that signals, the work, an empty submission that waits; and the
// same with this wait and the next signal in one submission. Two turns in flight.
#include <chrono>
#include <cstdio>

#include "bench/vulkan_host.h"
#include "cuda/device/device.h"
#include "cuda/device/stream.h"
#include "vulkan_interop/resources.h"

namespace voyager {
namespace {

constexpr int kTurns = 300;

__global__ void spin(long long clocks) {
  const long long start = clock64();
  while (clock64() - start < clocks) continue;
}

struct Timeline {
  Timeline(const vulkan::Device& device) : semaphore(vulkan::make_semaphore(device, true, true)) {
    cudaExternalSemaphoreHandleDesc desc{};
    desc.type = cudaExternalSemaphoreHandleTypeTimelineSemaphoreFd;
    desc.handle.fd = vulkan::export_semaphore(device, semaphore.get()).release();
    cuda::check(cudaImportExternalSemaphore(&imported, &desc), "a semaphore");
  }
  ~Timeline() { cudaDestroyExternalSemaphore(imported); }
  vulkan::Owned<VkSemaphore> semaphore;
  cudaExternalSemaphore_t imported = nullptr;
};

class Turns {
 public:
  Turns(const Host& host, const vulkan::Device& device)
      : host_(host), device_(device), to_cuda_(device), to_vulkan_(device) {}
  ~Turns() { vkQueueWaitIdle(host_.queue); }

  double alone(long long clocks) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kTurns; ++i) spin<<<1, 1, 0, stream_.get()>>>(clocks);
    stream_.wait();
    return milliseconds_a_turn(start);
  }
  double through_vulkan(long long clocks, bool merged) {
    const auto start = std::chrono::steady_clock::now();
    if (merged) submit(false, true);
    for (int i = 0; i < kTurns; ++i) {
      if (!merged) submit(false, true);
      cudaExternalSemaphoreWaitParams wait{};
      wait.params.fence.value = ++value_;
      cuda::check(cudaWaitExternalSemaphoresAsync(&to_cuda_.imported, &wait, 1, stream_.get()),
                  "wait");
      spin<<<1, 1, 0, stream_.get()>>>(clocks);
      cudaExternalSemaphoreSignalParams signal{};
      signal.params.fence.value = value_;
      cuda::check(
          cudaSignalExternalSemaphoresAsync(&to_vulkan_.imported, &signal, 1, stream_.get()),
          "signal");
      submit(true, merged && i + 1 < kTurns);
      if (i > 1) wait_for(value_ - 2);
    }
    wait_for(value_);
    return milliseconds_a_turn(start);
  }

 private:
  static double milliseconds_a_turn(std::chrono::steady_clock::time_point start) {
    const std::chrono::duration<double, std::milli> all = std::chrono::steady_clock::now() - start;
    return all.count() / kTurns;
  }
  // An empty submission: it waits for the turn's end, signals the next one's beginning.
  void submit(bool waits, bool signals) {
    const uint64_t wait_value = value_, signal_value = value_ + 1;
    const VkSemaphore wait = to_vulkan_.semaphore.get(), signal = to_cuda_.semaphore.get();
    const VkTimelineSemaphoreSubmitInfo values{VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                               nullptr,
                                               waits,
                                               &wait_value,
                                               signals,
                                               &signal_value};
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.pNext = &values;
    info.waitSemaphoreCount = waits;
    info.pWaitSemaphores = &wait;
    info.pWaitDstStageMask = &stage;
    info.signalSemaphoreCount = signals;
    info.pSignalSemaphores = &signal;
    Host::check(vkQueueSubmit(host_.queue, 1, &info, VK_NULL_HANDLE));
  }
  void wait_for(uint64_t value) const {
    const VkSemaphore semaphore = to_vulkan_.semaphore.get();
    const VkSemaphoreWaitInfo info{
        VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO, nullptr, 0, 1, &semaphore, &value};
    Host::check(vkWaitSemaphores(device_.handle(), &info, UINT64_MAX));
  }

  const Host& host_;
  const vulkan::Device& device_;
  Timeline to_cuda_, to_vulkan_;
  cuda::Stream stream_;
  uint64_t value_ = 0;
};

void run() {
  const cuda::Device whole(0, 0);
  const Host host(whole.uuid());
  const vulkan::Device device(host.desc(vulkan::Sync::timeline), whole.external_support());
  Turns turns(host, device);
  std::printf("%s\n", whole.name().c_str());
  for (const long long clocks : {0ll, 400'000ll, 800'000ll}) {
    turns.alone(clocks), turns.through_vulkan(clocks, false);
    std::printf("alone %.3f, through Vulkan %.3f, one submission a turn %.3f\n",
                turns.alone(clocks), turns.through_vulkan(clocks, false),
                turns.through_vulkan(clocks, true));
  }
}

}  // namespace
}  // namespace voyager

int main() {
  try {
    voyager::run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "turns_bench: %s\n", error.what());
    return 1;
  }
}
