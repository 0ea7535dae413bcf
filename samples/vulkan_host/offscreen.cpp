#include "offscreen.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "failure.h"
#include "files.h"
#include "readback.h"

namespace host {
namespace {

std::string stem_of(uint64_t number) {
  char name[32];
  std::snprintf(name, sizeof name, "%04llu", static_cast<unsigned long long>(number));
  return name;
}

// A frame in flight, and the files that it becomes.
struct Pending {
  Readback readback;
  std::string stem;  // empty: none
};

class Recorder {
 public:
  Recorder(const Device& device, const DepthConvention& depth, const OffscreenOptions& options)
      : device_(device), depth_(depth), options_(options) {}

  void begin(uint32_t slot, uint64_t number, VkExtent2D extent) {
    save(slot);
    Pending& pending = slots_[slot];
    if (pending.readback.extent().width != extent.width ||
        pending.readback.extent().height != extent.height)
      pending.readback = Readback(device_, extent, options_.write_depth);
    pending.stem = options_.folder + "/" + stem_of(number);
  }
  void record(uint32_t slot, VkCommandBuffer commands, const RenderTargets& targets) const {
    slots_[slot].readback.record(commands, targets);
  }
  // The slot's commands are done.
  void save(uint32_t slot) {
    Pending& pending = slots_[slot];
    if (pending.stem.empty()) return;
    const Readback& from = pending.readback;
    write_png(pending.stem + ".png", from.extent().width, from.extent().height, from.rgba());
    if (options_.write_depth) {
      std::vector<float> metres(from.depth().size());
      std::transform(from.depth().begin(), from.depth().end(), metres.begin(),
                     [&](float z) { return depth_.metres(z); });
      write_pfm(pending.stem + ".pfm", from.extent().width, from.extent().height, metres);
    }
    pending.stem.clear();
  }

 private:
  const Device& device_;
  const DepthConvention& depth_;
  const OffscreenOptions& options_;
  std::array<Pending, kFramesInFlight> slots_;
};

}  // namespace

void prepare_folder(const OffscreenOptions& options, const std::vector<std::string>& others) {
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) throw Failure(kMachine, options.folder + ": " + error.message());
  require_pictures(options.folder, others, [&](std::string_view name) {
    uint64_t number = 0;
    const auto [end, problem] = std::from_chars(name.data(), name.data() + name.size(), number);
    const std::string_view extension = name.substr(static_cast<size_t>(end - name.data()));
    return problem == std::errc() && number < options.frames &&
           name.substr(0, name.size() - extension.size()) == stem_of(number) &&
           (extension == ".png" || (extension == ".pfm" && options.write_depth));
  });
  require_writable(options.folder + "/" + stem_of(0) + ".png");
}

void run_offscreen(const Device& device, Renderer& renderer, VoyagerLayer& voyager,
                   const DepthConvention& depth, const std::vector<Camera>& cameras,
                   const Look& look, const OffscreenOptions& options, FrameLog& log) {
  Recorder recorder(device, depth, options);
  for (uint64_t i = 0; i < options.frames; ++i) {
    const Camera& camera = cameras[i % cameras.size()];
    const VkExtent2D extent = {camera.width, camera.height};
    if (extent.width != renderer.extent().width || extent.height != renderer.extent().height)
      renderer.resize(extent);
    const uint32_t slot = renderer.wait_for_slot();
    recorder.begin(slot, i, extent);
    Delivery delivery;
    delivery.record = [&](VkCommandBuffer commands, const RenderTargets& targets) {
      recorder.record(slot, commands, targets);
    };
    renderer.draw(camera, look, delivery);
    log.add(look.composite == Composite::none ? nullptr : &voyager);
  }
  device.wait_idle();
  for (uint32_t slot = 0; slot < kFramesInFlight; ++slot) recorder.save(slot);
}

}  // namespace host
