#include "runtime/cpu/cpu_backend.h"

#include <numeric>

#include "runtime/base/error.h"
#include "runtime/cpu/bin.h"
#include "runtime/cpu/rasterize.h"
#include "runtime/frame/depth_order.h"
#include "runtime/frame/host_instances.h"
#include "runtime/frame/host_pipeline.h"
#include "runtime/frame/project_params.h"
#include "runtime/frame/resolve.h"
#include "runtime/math/alpha_lut.h"

namespace voyager {
namespace {

using namespace cpu;

constexpr size_t kProjectBlock = 4096;

class CpuPipeline final : public HostPipeline {
 public:
  CpuPipeline(const Scenes& scenes, const PipelineDesc& desc, std::pmr::memory_resource* memory,
              Workers& workers)
      : desc_(desc),
        workers_(workers),
        instances_(scenes, desc, kProjectBlock, memory),
        lut_(memory),
        splats_(memory),
        visible_(memory),
        keys_(memory),
        order_(memory),
        bins_(memory),
        pixels_(memory),
        depth_(memory) {
    if (desc.exponential != Exponential::lut) return;
    lut_.resize(desc.lut_size + 1);
    fill_alpha_lut(desc.lut_size, lut_.data());
  }

  void search(const FrameInput& frame) override { instances_.update(frame, workers_); }
  void project(const FrameInput& frame) override;
  void project(const HostInstance& instance);
  void sort(const FrameInput& frame) override;
  void bin(const FrameInput& frame) override;
  void rasterize(const FrameInput& frame) override;
  void write(const FrameInput& frame, const Image& image) override {
    resolve_image(
        frame, image, workers_, [&](size_t i) -> const Pixel& { return pixels_[i]; },
        [&](size_t i) { return depth_[i]; });
  }

  void collect(FrameStats& stats) const override {
    instances_.collect(stats);
    stats.splats = order_.size();
    stats.pairs_before = bins_.pairs_before();
    stats.pairs_after = bins_.pairs_after();
  }
  void read_cut(size_t instance, std::pmr::vector<uint32_t>& cut) const override {
    cut = instances_.cut(instance);
  }
  bool cut_is_near() const override { return true; }

 private:
  PipelineDesc desc_;
  Workers& workers_;
  HostInstances instances_;
  std::pmr::vector<float> lut_;
  std::pmr::vector<Splat> splats_;      // of a block of places, from its first on
  std::pmr::vector<uint32_t> visible_;  // splats of each block
  std::pmr::vector<uint64_t> keys_;
  std::pmr::vector<uint32_t> order_;  // splats by depth
  TileBins bins_;
  std::pmr::vector<Pixel> pixels_;
  std::pmr::vector<float> depth_;
};

void CpuPipeline::project(const FrameInput&) {
  const size_t places = instances_.places();
  if (splats_.size() < places) splats_.resize(places);
  visible_.assign((places + kProjectBlock - 1) / kProjectBlock, 0);
  for (const HostInstance& instance : instances_.all()) project(instance);
}

void CpuPipeline::project(const HostInstance& instance) {
  const auto& items = instance.draws.items();
  const ProjectParams params = project_params(*instance.scene, instance.camera, desc_.exponential);
  const GaussianArrays arrays = gaussian_arrays(*instance.scene);
  workers_.for_blocks(items.size(), kProjectBlock, [&](size_t begin, size_t end) {
    const size_t first = instance.first + begin;
    size_t out = first;
    for (size_t i = begin; i < end; ++i)
      out += voyager::project(params, arrays, items[i], splats_[out]);
    visible_[first / kProjectBlock] = static_cast<uint32_t>(out - first);
  });
}

void CpuPipeline::sort(const FrameInput&) {
  keys_.clear();
  for (size_t block = 0; block < visible_.size(); ++block)
    for (size_t i = 0; i < visible_[block]; ++i) {
      const auto index = static_cast<uint32_t>(block * kProjectBlock + i);
      keys_.push_back(depth_key(splats_[index].depth, index));
    }
  sort_by_depth(keys_, workers_);
  order_.resize(keys_.size());
  for (size_t i = 0; i < keys_.size(); ++i) order_[i] = depth_key_index(keys_[i]);
}

void CpuPipeline::bin(const FrameInput& frame) {
  bins_.build(splats_.data(), order_, tile_grid(frame.camera.width, frame.camera.height),
              desc_.alpha_filter, workers_);
}

void CpuPipeline::rasterize(const FrameInput& frame) {
  const size_t count = size_t{frame.camera.width} * frame.camera.height;
  if (pixels_.size() < count) pixels_.resize(count);
  const bool limits = frame.limits.values != nullptr, depth = frame.depth_wanted || limits;
  if (depth && depth_.size() < count) depth_.resize(count);
  const RasterParams params{splats_.data(),
                            lut_.data(),
                            static_cast<float>(desc_.lut_size) / kLutRange,
                            frame.camera.width,
                            frame.camera.height,
                            pixels_.data(),
                            depth ? depth_.data() : nullptr,
                            frame.limits};
  const RasterizeTile run = pick_rasterizer(desc_.exponential, desc_.alpha_filter, depth, limits);
  const TileGrid grid = tile_grid(frame.camera.width, frame.camera.height);
  const auto columns = static_cast<uint32_t>(grid.columns);
  workers_.for_blocks(size_t{columns} * static_cast<size_t>(grid.rows), 1,
                      [&](size_t index, size_t) {
                        const auto tile = static_cast<uint32_t>(index);
                        run(params, {tile % columns, tile / columns, bins_.tile(index)});
                      });
}

class CpuBackend final : public Backend {
 public:
  std::string device_name() const override {
    return std::string("CPU (") + rasterizers().back().name + ")";
  }
  std::unique_ptr<Pipeline> create_pipeline(const Scenes& scenes, const PipelineDesc& desc,
                                            std::pmr::memory_resource* memory,
                                            Workers& workers) override {
    if (desc.splatting != Splatting::ours)
      throw Error(ErrorCode::unsupported,
                  "splatting: found 3dgs, the CPU backend has ours only (CUDA has both)");
    if (desc.exponential == Exponential::half2)
      throw Error(ErrorCode::unsupported,
                  "exponential: found half2, the CPU backend has exact, ex2 and lut");
    return std::make_unique<CpuPipeline>(scenes, desc, memory, workers);
  }
  std::unique_ptr<SceneSearch> create_search(std::shared_ptr<const Scene> scene,
                                             const SearchDesc& desc,
                                             std::pmr::memory_resource* memory,
                                             Workers& workers) override {
    return create_host_search(std::move(scene), desc, memory, workers);
  }
};

}  // namespace

std::unique_ptr<Backend> create_cpu_backend() {
  return std::make_unique<CpuBackend>();
}

}  // namespace voyager
