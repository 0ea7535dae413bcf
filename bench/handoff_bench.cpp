// What the hand-off to a Vulkan host adds to a frame on CUDA: release, semaphores, frame,
// acquire; against the same frame drawn for nobody.
//
//   handoff_bench SCENE CAMERAS WxH [MULTIPROCESSORS [FRAMES]]
//
// A line a mode: medians and p99 of the host's milliseconds inside the frame's call, of the
// frame from the first submission to the last fence with one in flight, and the mean of frames
// with two in flight. The first line is the frame alone, its call and its device time.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/vulkan_host.h"
#include "runtime/base/error.h"
#include "runtime/frame/backend_module.h"
#include "runtime/frame/eye_camera.h"
#include "runtime/frame/load.h"
#include "runtime/frame/view.h"
#include "tools/cameras.h"
#include "vulkan_interop/ring.h"

namespace voyager {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

struct Work {
  std::vector<FrameInput> frames;
  uint32_t width = 0, height = 0;
  size_t count = 0;
  const FrameInput& frame(size_t i) const { return frames[i % frames.size()]; }
};

class HandOff {
 public:
  HandOff(const Host& host, const Backend& backend, const Work& work, vulkan::Sync sync)
      : host_(host), work_(work), sync_(sync) {
    vulkan::RingDesc ring;
    ring.format = ColorFormat::rgba8;
    ring.width = work.width;
    ring.height = work.height;
    ring.images = 2;
    ring_.emplace(
        std::make_shared<vulkan::Device>(host.desc(sync), backend.external_support()), ring,
        [&](ExternalRingDesc shared) { return backend.import_ring(std::move(shared)); },
        std::pmr::get_default_resource());
    for (Slot& slot : slots_) {
      slot.before = host.allocate();
      slot.after = host.allocate();
      const VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, 0};
      vulkan::check(vkCreateFence(host.device, &info, nullptr, &slot.fence), "vkCreateFence");
    }
  }
  ~HandOff() {
    for (Slot& slot : slots_) vkDestroyFence(host_.device, slot.fence, nullptr);
  }
  HandOff(const HandOff&) = delete;
  HandOff& operator=(const HandOff&) = delete;

  // Of each frame's call, milliseconds; `whole` of each frame, with one in flight.
  std::vector<double> run(View& view, size_t in_flight, std::vector<double>* whole) {
    std::vector<double> calls;
    for (size_t i = 0; i < work_.count; ++i) {
      Slot& slot = slots_[i % 2];
      if (i >= in_flight && in_flight == 2) host_.wait_for(slot.fence);
      const auto start = Clock::now();
      calls.push_back(frame(view, i, slot));
      if (in_flight == 2) continue;
      host_.wait_for(slot.fence);
      whole->push_back(milliseconds_since(start));
    }
    if (in_flight == 2)
      for (Slot& slot : slots_) host_.wait_for(slot.fence);
    return calls;
  }

 private:
  struct Slot {
    VkCommandBuffer before = VK_NULL_HANDLE, after = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
  };

  double frame(View& view, size_t i, Slot& slot) {
    const auto index = static_cast<uint32_t>(i % 2);
    const vulkan::RingImage image = ring_->image(index);
    const bool timelines = sync_ == vulkan::Sync::timeline;
    vulkan::FrameSync values;
    if (sync_ == vulkan::Sync::binary) values = {1, 1};
    if (timelines) ++value_, values = {value_, value_};
    vulkan::Use use{slot.before, 0, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                    VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT};
    Host::begin(slot.before);
    ring_->record_release(index, use);
    const bool blocks = sync_ == vulkan::Sync::host;
    host_.submit(slot.before, VK_NULL_HANDLE, image.released, value_, timelines,
                 blocks ? slot.fence : VK_NULL_HANDLE);
    if (blocks) host_.wait_for(slot.fence);
    const auto start = Clock::now();
    view.render(work_.frame(i), ring_->begin_frame(index, 0, values));
    ring_->end_frame(values);
    const double call = milliseconds_since(start);
    Host::begin(slot.after);
    use.commands = slot.after;
    ring_->record_acquire(index, use);
    host_.submit(slot.after, image.rendered, VK_NULL_HANDLE, value_, timelines, slot.fence);
    return call;
  }

  const Host& host_;
  const Work& work_;
  vulkan::Sync sync_;
  std::optional<vulkan::Ring> ring_;
  Slot slots_[2];
  uint64_t value_ = 0;
};

void print(const char* name, const std::vector<double>& call, const std::vector<double>& whole,
           double two, double device) {
  std::printf("%-8s call %.3f / %.3f  frame %.3f / %.3f  two in flight %.3f  on the device %.3f\n",
              name, quantile(call, 0.5), quantile(call, 0.99), quantile(whole, 0.5),
              quantile(whole, 0.99), two, device);
}

void bench(View& view, const Host& host, const Backend& backend, const Work& work) {
  Image nobody;
  nobody.format = ColorFormat::rgba8;
  nobody.width = work.width;
  nobody.height = work.height;
  std::vector<double> whole, device;
  for (size_t i = 0; i < work.count + 20; ++i) {
    const auto start = Clock::now();
    view.render(work.frame(i), nobody);
    if (i < 20) continue;
    whole.push_back(milliseconds_since(start));
    device.push_back(view.stats().total_milliseconds);
  }
  print("alone", whole, whole, 0, quantile(device, 0.5));
  const struct {
    const char* name;
    vulkan::Sync sync;
  } modes[] = {{"timeline", vulkan::Sync::timeline},
               {"binary", vulkan::Sync::binary},
               {"host", vulkan::Sync::host}};
  for (const auto& mode : modes) {
    HandOff hand_off(host, backend, work, mode.sync);
    std::vector<double> frames;
    hand_off.run(view, 2, nullptr);
    const std::vector<double> calls = hand_off.run(view, 1, &frames);
    const auto start = Clock::now();
    hand_off.run(view, 2, nullptr);
    const double two = milliseconds_since(start) / static_cast<double>(work.count);
    print(mode.name, calls, frames, two, view.stats().total_milliseconds);
  }
}

void run(int argc, char** argv) {
  if (argc < 4)
    throw Error(ErrorCode::invalid_argument,
                "handoff_bench SCENE CAMERAS WxH [MULTIPROCESSORS [FRAMES]]");
  Work work;
  std::sscanf(argv[3], "%ux%u", &work.width, &work.height);
  BackendModuleOptions options;
  if (argc > 4) options.multiprocessors = static_cast<unsigned>(std::atoi(argv[4]));
  work.count = argc > 5 ? static_cast<size_t>(std::atoi(argv[5])) : 400;
  for (const tools::Camera& from : tools::read_cameras(argv[2])) {
    FrameInput frame;
    Camera& camera = frame.eyes[0].camera;
    camera.width = work.width;
    camera.height = work.height;
    const tools::Camera sized = from.resized(work.width, work.height);
    for (int i = 0; i < 3; ++i) camera.eye[i] = sized.pose.position[i];
    const double(&q)[4] = sized.pose.orientation;
    camera.world_to_view = world_to_view(normalise(Quatd{q[3], q[0], q[1], q[2]}));
    const VoyFrustum f = sized.frustum();
    set_frustum(camera, f.left, f.right, f.up, f.down);
    work.frames.push_back(frame);
  }
  Workers workers;
  auto* const memory = std::pmr::get_default_resource();
  const std::unique_ptr<Backend> backend = load_backend("cuda", options);
  const auto scene = load_scene(open_file_source(argv[1]), memory, workers);
  const Host host(backend->device_uuid());
  PipelineDesc desc;
  desc.exponential = Exponential::ex2;
  View view(scene, *backend, desc, memory, workers);
  std::printf("%s\n", backend->device_name().c_str());
  bench(view, host, *backend, work);
}

}  // namespace
}  // namespace voyager

int main(int argc, char** argv) {
  try {
    voyager::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "handoff_bench: %s\n", error.what());
    return 1;
  }
}
