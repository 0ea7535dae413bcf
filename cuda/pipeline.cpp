#include "cuda/pipeline.h"

#include <vector>

#include "cuda/frame_image.h"
#include "cuda/splat_state.h"
#include "cuda/stage_timer.h"
#include "runtime/frame/instance.h"
#include "runtime/frame/project_params.h"
#include "runtime/math/alpha_lut.h"

namespace voyager::cuda {
namespace {

Buffer<float> upload_lut(const PipelineDesc& desc) {
  if (desc.exponential != Exponential::lut) return {};
  std::vector<float> lut(desc.lut_size + 1);
  fill_alpha_lut(desc.lut_size, lut.data());
  return upload(std::span<const float>(lut));
}

class SplatPipeline final : public Pipeline {
 public:
  SplatPipeline(std::shared_ptr<const Device> device, std::vector<DeviceInstance> instances,
                const PipelineDesc& desc)
      : device_(std::move(device)),
        instances_(std::move(instances)),
        desc_(desc),
        lut_(upload_lut(desc)),
        splats_(bin_blocks(device_->multiprocessors())) {}

  // What it frees belongs to the device's context.
  ~SplatPipeline() override { device_->use_quietly(); }

  void draw(const FrameInput& frame, const Image& image, FrameStats& stats) override;
  void resolve(const FrameInput&, const Image& image, FrameStats& stats) override {
    image_.resolve(image, stats);
  }
  void read_cut(size_t instance, std::pmr::vector<uint32_t>& cut) const override {
    device_->use();
    instances_.all()[instance].draws->read_cut(cut);
  }
  bool cut_is_near() const override { return false; }

 private:
  void launch_splatting(const FrameInput& frame, const TileGrid& grid, const RasterTarget& target);
  void launch_projections(const FrameInput& frame, SplatFrame& work);
  SplatCounters counters() const;
  void collect(const SplatCounters& counted, const Image& image, FrameStats& stats) const;
  void count_bytes(const SplatCounters& counted, const Image& image, FrameStats& stats) const;

  std::shared_ptr<const Device> device_;
  DeviceInstances instances_;
  PipelineDesc desc_;
  Buffer<float> lut_;
  SplatState splats_;
  FrameImage image_;
  StageTimer timer_;
};

// One instance after the other, so that each finds on the device where its slots begin.
void SplatPipeline::launch_projections(const FrameInput& frame, SplatFrame& work) {
  for (size_t i = 0; i < instances_.all().size(); ++i) {
    const DeviceInstance& instance = instances_.all()[i];
    work.gaussians = instance.gaussians->view();
    work.draws = instance.draws->view();
    work.params = project_params(*instance.scene, instance_camera(frame, i), desc_.exponential);
    if (launch_project(work, desc_.alpha_filter)) ++work.instance;
  }
}

void SplatPipeline::launch_splatting(const FrameInput& frame, const TileGrid& grid,
                                     const RasterTarget& target) {
  SplatFrame work{};
  work.splats = splats_.view(grid);
  work.multiprocessors = device_->multiprocessors();
  work.stream = timer_.stream();
  splats_.begin_frame(grid, work.stream);
  launch_projections(frame, work);
  timer_.end(kProject);
  launch_bin(work);
  timer_.end(kBin);
  launch_sort(work);
  timer_.end(kSort);
  launch_rasterize(work,
                   {desc_.exponential, desc_.alpha_filter, desc_.count_pixels,
                    instances_.siblings(), lut_.data(), desc_.lut_size},
                   target);
  timer_.end(kRasterize);
}

SplatCounters SplatPipeline::counters() const {
  timer_.wait();
  SplatCounters counters;
  check(cudaMemcpy(&counters, splats_.counters(), sizeof counters, cudaMemcpyDeviceToHost),
        "counters");
  return counters;
}

void SplatPipeline::draw(const FrameInput& frame, const Image& image, FrameStats& stats) {
  device_->use();
  const TileGrid grid = tile_grid(image.width, image.height);
  splats_.fit(grid);
  const RasterTarget target = image_.target(frame, image);
  timer_.begin();
  instances_.update(frame, timer_.stream());
  timer_.end(kSearch);
  launch_splatting(frame, grid, target);
  SplatCounters counted = counters();
  // A frame that found too little room is drawn again with more.
  while (splats_.grow(counted)) {
    timer_.go_back_to(kSearch);
    launch_splatting(frame, grid, target);
    counted = counters();
  }
  collect(counted, image, stats);
}

void SplatPipeline::collect(const SplatCounters& counted, const Image& image,
                            FrameStats& stats) const {
  instances_.collect(stats);
  stats.splats = counted.splats;
  stats.pairs_before = counted.pairs_boxed;
  stats.pairs_after = counted.pairs;
  stats.pairs_dropped = splats_.dropped(counted);
  stats.pixels_evaluated = counted.evaluated;
  stats.pixels_blended = counted.blended;

  count_bytes(counted, image, stats);
  timer_.collect(stats);
}

// What each stage reads and writes of its own arrays; what siblings share of their parents
// is left out.
void SplatPipeline::count_bytes(const SplatCounters& counted, const Image& image,
                                FrameStats& stats) const {
  const TileGrid grid = tile_grid(image.width, image.height);
  const uint64_t tiles = static_cast<uint64_t>(grid.columns) * static_cast<uint64_t>(grid.rows);
  const uint64_t offsets = tiles * bin_blocks(device_->multiprocessors()) * sizeof(uint32_t);
  const uint64_t pixels = uint64_t{image.width} * image.height, pairs = counted.pairs;
  uint64_t candidates = 0;
  for (const InstanceCounters& instance : counted.instances) candidates += instance.candidates;
  constexpr uint64_t kRecord = sizeof(SplatRecord), kKey = sizeof(DepthKey);
  stats.gaussian_bytes = instances_.bytes_a_gaussian();
  stats.bytes[kProject] =
      uint64_t{counted.places} * instances_.bytes_a_place() + 2 * sizeof(uint32_t) * candidates +
      counted.splats * (stats.gaussian_bytes + kRecord) + counted.strips * sizeof(TileStrip);
  stats.bytes[kBin] = 2 * counted.strips * sizeof(TileStrip) + 2 * offsets + pairs * kKey;
  stats.bytes[kSort] = 2 * pairs * kKey;
  stats.bytes[kRasterize] = pairs * (kKey + kRecord) + pixels * pixel_bytes(image.format);
}

}  // namespace

std::unique_ptr<Pipeline> create_pipeline(std::shared_ptr<const Device> device,
                                          std::vector<DeviceInstance> instances,
                                          const PipelineDesc& desc) {
  return std::make_unique<SplatPipeline>(std::move(device), std::move(instances), desc);
}

}  // namespace voyager::cuda
