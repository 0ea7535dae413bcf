// A module in CUDA's place: the CPU backend on the mock's device, which takes images to share and
// submits frames that end when the test says so.
#include "tests/abi/stuck_module.h"

#include <algorithm>
#include <cstring>

#include "runtime/cpu/cpu_backend.h"
#include "runtime/frame/backend_module.h"

extern "C" __attribute__((visibility("default"))) StuckModule voyager_stuck_module;
StuckModule voyager_stuck_module;

namespace voyager {
namespace {

StuckModule& state() {
  return voyager_stuck_module;
}

class Counted {
 public:
  explicit Counted(std::atomic<int>& live) : live_(live) { ++live_; }
  ~Counted() {
    --live_;
    if (!state().idle) ++state().hangs;
  }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  std::atomic<int>& live_;
};

class StuckPipeline final : public Pipeline {
 public:
  explicit StuckPipeline(std::unique_ptr<Pipeline> inner) : inner_(std::move(inner)) {}
  void set_scenes(const Scenes& scenes, std::span<const size_t> from) override {
    inner_->set_scenes(scenes, from);
  }
  void draw(const FrameInput& frame, FrameStats& stats) override { inner_->draw(frame, stats); }
  void resolve(const FrameInput& frame, FrameStats& stats) override {
    inner_->resolve(frame, stats);
  }
  void submit(const FrameInput&, bool) override { ++under_way_; }
  bool finish(bool wait, FrameStats&) override {
    if (under_way_ == 0) return false;
    if (state().idle) return --under_way_, true;
    if (wait) throw Error(ErrorCode::timeout, "view: found a frame in flight that did not end");
    return false;
  }
  bool counts_changes() const override { return true; }
  void read_cut(size_t instance, std::pmr::vector<uint32_t>& cut) const override {
    inner_->read_cut(instance, cut);
  }
  bool cut_is_near() const override { return false; }

 private:
  std::unique_ptr<Pipeline> inner_;
  int under_way_ = 0;
  Counted counted_{state().pipelines};
};

class StuckRing final : public ExternalRing {
 public:
  explicit StuckRing(ExternalRingDesc desc) : desc_(std::move(desc)) {}
  bool idle() const override { return state().idle; }
  void wait() const override {}
  std::chrono::milliseconds patience_at_end() const override { return kStuckPatience; }

 private:
  ExternalRingDesc desc_;
  Counted counted_{state().rings};
};

class StuckBackend final : public Backend {
 public:
  std::string device_name() const override { return "stuck"; }
  std::array<uint8_t, 16> device_uuid() const override {
    return {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};  // the mock's
  }
  ExternalSupport external_support() const override { return {true, true, true}; }
  std::unique_ptr<ExternalRing> import_ring(ExternalRingDesc&& desc) const override {
    return std::make_unique<StuckRing>(std::move(desc));
  }
  std::unique_ptr<Pipeline> create_pipeline(const Scenes& scenes, const PipelineDesc& desc,
                                            std::pmr::memory_resource* memory,
                                            Workers& workers) override {
    PipelineDesc exact = desc;
    exact.exponential = Exponential::exact;
    return std::make_unique<StuckPipeline>(inner_->create_pipeline(scenes, exact, memory, workers));
  }
  std::unique_ptr<SceneSearch> create_search(std::shared_ptr<const Scene> scene,
                                             const SearchDesc& desc,
                                             std::pmr::memory_resource* memory,
                                             Workers& workers) override {
    return inner_->create_search(std::move(scene), desc, memory, workers);
  }

 private:
  std::unique_ptr<Backend> inner_ = create_cpu_backend();
  Counted counted_{state().backends};
};

Backend* create(const BackendModuleOptions&, ErrorCode*, char*, size_t) {
  return new StuckBackend;
}

bool list(std::vector<BackendDevice>& devices, ErrorCode*, char*, size_t) {
  BackendDevice& device = devices.emplace_back();
  device.name = "stuck";
  device.uuid = StuckBackend().device_uuid();
  return true;
}

}  // namespace
}  // namespace voyager

extern "C" __attribute__((visibility("default")))
const voyager::BackendModule voyager_backend_module = {voyager::backend_module_stamp(),
                                                       voyager::create, voyager::list};
