#include "cuda/pipeline.h"

#include <vector>

#include "cuda/frame_image.h"
#include "cuda/frame_limits.h"
#include "cuda/splat_state.h"
#include "cuda/stage_timer.h"
#include "runtime/base/error.h"
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
  SplatPipeline(std::shared_ptr<const Device> device, std::shared_ptr<const Scene> scene,
                std::shared_ptr<const DeviceScene> gaussians, std::unique_ptr<Draws> draws,
                const PipelineDesc& desc)
      : device_(std::move(device)),
        scene_(std::move(scene)),
        gaussians_(std::move(gaussians)),
        draws_(std::move(draws)),
        desc_(desc),
        lut_(upload_lut(desc)),
        splats_(bin_blocks(device_->multiprocessors())) {}

  // What it frees belongs to the device's context.
  ~SplatPipeline() override { device_->use_quietly(); }

  void draw(const FrameInput& frame, const Image& image, FrameStats& stats) override;
  void resolve(const FrameInput&, const Image& image, FrameStats& stats) override {
    image_.resolve(image, stats);
  }
  void read_cut(std::pmr::vector<uint32_t>& cut) const override {
    device_->use();
    draws_->read_cut(cut);
  }
  bool cut_is_near() const override { return false; }

 private:
  void launch_splatting(const FrameInput& input, const SplatFrame& frame,
                        const RasterTarget& target);
  SplatCounters counters() const;
  void collect(const SplatCounters& counted, const Image& image, FrameStats& stats) const;
  void count_bytes(const SplatCounters& counted, const Image& image, FrameStats& stats) const;

  std::shared_ptr<const Device> device_;
  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const DeviceScene> gaussians_;
  std::unique_ptr<Draws> draws_;
  PipelineDesc desc_;
  Buffer<float> lut_;
  SplatState splats_;
  FrameImage image_;
  FrameLimits limits_;
  StageTimer timer_;
};

void SplatPipeline::launch_splatting(const FrameInput& input, const SplatFrame& frame,
                                     const RasterTarget& target) {
  const TileGrid& grid = frame.splats.grid;
  splats_.begin_frame(grid, frame.stream);
  launch_project(frame, desc_.alpha_filter);
  timer_.end(kProject);
  launch_bin(frame);
  timer_.end(kBin);
  launch_sort(frame);
  timer_.end(kSort);
  launch_rasterize(frame,
                   {desc_.exponential, desc_.alpha_filter, desc_.count_pixels, lut_.data(),
                    desc_.lut_size, limits_.upload(input, frame.stream)},
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
  if (desc_.count_pixels && frame.limits.values != nullptr)
    throw Error(ErrorCode::unsupported,
                "depth limits: found some, pixels are counted of frames without");
  device_->use();
  const TileGrid grid = tile_grid(image.width, image.height);
  splats_.fit(grid);
  limits_.fit(frame);
  const RasterTarget target = image_.target(frame, image);
  timer_.begin();
  draws_->update(frame, timer_.stream());
  timer_.end(kSearch);
  SplatFrame work{gaussians_->view(),
                  draws_->view(),
                  project_params(*scene_, frame.camera, desc_.exponential),
                  splats_.view(grid),
                  device_->multiprocessors(),
                  timer_.stream()};
  launch_splatting(frame, work, target);
  SplatCounters counted = counters();
  // A frame that found too little room is drawn again with more.
  while (splats_.grow(counted)) {
    work.splats = splats_.view(grid);
    timer_.go_back_to(kSearch);
    launch_splatting(frame, work, target);
    counted = counters();
  }
  collect(counted, image, stats);
}

void SplatPipeline::collect(const SplatCounters& counted, const Image& image,
                            FrameStats& stats) const {
  draws_->collect(stats);
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
  const CutList list = draws_->view().list;
  const uint64_t place = sizeof(float4) + (list.nodes != nullptr ? sizeof(uint32_t) : 0) +
                         (list.weights != nullptr ? sizeof(float) : 0);
  constexpr uint64_t kRecord = sizeof(SplatRecord), kKey = sizeof(DepthKey);
  stats.gaussian_bytes = gaussians_->bytes_a_gaussian();
  stats.bytes[kProject] = counted.places * place + 2 * sizeof(uint32_t) * counted.candidates +
                          counted.splats * (stats.gaussian_bytes + kRecord) +
                          counted.strips * sizeof(TileStrip);
  stats.bytes[kBin] = 2 * counted.strips * sizeof(TileStrip) + 2 * offsets + pairs * kKey;
  stats.bytes[kSort] = 2 * pairs * kKey;
  stats.bytes[kRasterize] = pairs * (kKey + kRecord) + pixels * pixel_bytes(image.format);
}

}  // namespace

std::unique_ptr<Pipeline> create_pipeline(std::shared_ptr<const Device> device,
                                          std::shared_ptr<const Scene> scene,
                                          std::shared_ptr<const DeviceScene> gaussians,
                                          std::unique_ptr<Draws> draws, const PipelineDesc& desc) {
  return std::make_unique<SplatPipeline>(std::move(device), std::move(scene), std::move(gaussians),
                                         std::move(draws), desc);
}

}  // namespace voyager::cuda
