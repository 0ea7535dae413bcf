#include "cuda/pipeline.h"

#include <algorithm>
#include <deque>
#include <vector>

#include "cuda/external_ring.h"
#include "cuda/frame_image.h"
#include "cuda/frame_limits.h"
#include "cuda/frame_report.h"
#include "cuda/splat_state.h"
#include "runtime/base/error.h"
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

  // What it frees belongs to the device's context, and to frames that may be under way.
  ~SplatPipeline() override {
    device_->use_quietly();
    cudaStreamSynchronize(stream_.get());
  }

  void draw(const FrameInput& frame, const Image& image, FrameStats& stats) override;
  void resolve(const FrameInput&, const Image& image, FrameStats& stats) override {
    image_.resolve(image, stats);
  }
  void submit(const FrameInput& frame, const Image& image, bool checked) override;
  bool finish(bool wait, FrameStats& stats) override;
  bool counts_changes() const override { return instances_.counts_changes(); }
  void read_cut(size_t instance, std::pmr::vector<uint32_t>& cut) const override {
    device_->use();
    instances_.all()[instance].draws->read_cut(cut);
  }
  bool cut_is_near() const override { return false; }

 private:
  using Report = std::unique_ptr<FrameReport>;

  Report begin_frame(const FrameInput& frame, const Image& image);
  void launch_search(const FrameInput& frame, FrameReport& report);
  SplatFrame work(const TileGrid& grid) const;
  void launch_lists(const FrameInput& frame, FrameReport& report);
  void launch_checked_lists(const FrameInput& frame, FrameReport& report);
  void launch_projections(const FrameInput& frame, SplatFrame& work);
  void launch_image(const RasterTarget& target, const DepthLimits& limits, FrameReport& report);
  void copy(FrameReport& report) const {
    report.copy(splats_.counters(), instances_, stream_.get());
  }
  void make_room();
  void collect(const FrameReport& report, FrameStats& stats) const;
  void count_bytes(const FrameReport& report, FrameStats& stats) const;

  std::shared_ptr<const Device> device_;
  DeviceInstances instances_;
  PipelineDesc desc_;
  Buffer<float> lut_;
  SplatState splats_;
  FrameImage image_;
  FrameLimits limits_;
  Stream stream_;
  std::vector<Report> free_;      // made as many as were under way at once
  std::deque<Report> under_way_;  // the oldest first
  SplatRoom wanted_;              // by what frames that were under way have used
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

SplatFrame SplatPipeline::work(const TileGrid& grid) const {
  SplatFrame work{};
  work.splats = splats_.view(grid);
  work.multiprocessors = device_->multiprocessors();
  work.stream = stream_.get();
  return work;
}

// Up to the tiles' lists.
void SplatPipeline::launch_lists(const FrameInput& frame, FrameReport& report) {
  report.room = splats_.room();
  SplatFrame lists = work(report.grid);
  splats_.begin_frame(report.grid, stream_.get());
  launch_projections(frame, lists);
  report.timer.end(kProject);
  launch_bin(lists);
  report.timer.end(kBin);
  launch_sort(lists);
  report.timer.end(kSort);
}

// Lists that found too little room are made again with more.
void SplatPipeline::launch_checked_lists(const FrameInput& frame, FrameReport& report) {
  for (;;) {
    launch_lists(frame, report);
    copy(report);
    report.wait();
    if (!splats_.grow(room_for(report.counters()))) return;
    report.timer.go_back_to(kSearch);
  }
}

void SplatPipeline::launch_image(const RasterTarget& target, const DepthLimits& limits,
                                 FrameReport& report) {
  launch_rasterize(work(report.grid),
                   {desc_.exponential, desc_.alpha_filter, desc_.count_pixels,
                    instances_.siblings(), lut_.data(), desc_.lut_size, limits},
                   target);
  report.timer.end(kRasterize);
}

SplatPipeline::Report SplatPipeline::begin_frame(const FrameInput& frame, const Image& image) {
  if (desc_.count_pixels && (frame.limits.values != nullptr || image.external.limited))
    throw Error(ErrorCode::unsupported,
                "depth limits: found some, pixels are counted of frames without");
  device_->use();
  make_room();
  Report report;
  if (free_.empty()) {
    report = std::make_unique<FrameReport>(stream_, instances_);
  } else {
    report = std::move(free_.back());
    free_.pop_back();
  }
  report->grid = tile_grid(image.width, image.height);
  report->target_bytes = uint64_t{image.width} * image.height * pixel_bytes(image.format);
  splats_.fit(report->grid);
  limits_.fit(frame);
  return report;
}

void SplatPipeline::launch_search(const FrameInput& frame, FrameReport& report) {
  report.timer.begin();
  instances_.update(frame, stream_.get());
  report.timer.end(kSearch);
}

// Frames that are left under way cannot be drawn again: they get room before they need it.
void SplatPipeline::make_room() {
  const SplatRoom wanted = std::exchange(wanted_, {}), room = splats_.room();
  if (wanted.slots <= room.slots && wanted.strips <= room.strips && wanted.pairs <= room.pairs)
    return;
  stream_.wait();
  splats_.grow(wanted);
}

void SplatPipeline::draw(const FrameInput& frame, const Image& image, FrameStats& stats) {
  Report report = begin_frame(frame, image);
  const RasterTarget target = image_.target(frame, image);
  launch_search(frame, *report);
  for (;;) {
    launch_lists(frame, *report);
    launch_image(target, limits_.upload(frame, stream_.get()), *report);
    copy(*report);
    report->wait();
    if (!splats_.grow(room_for(report->counters()))) break;
    report->timer.go_back_to(kSearch);
  }
  collect(*report, stats);
  free_.push_back(std::move(report));
}

void SplatPipeline::submit(const FrameInput& frame, const Image& image, bool checked) {
  under_way_.push_back(begin_frame(frame, image));
  FrameReport& report = *under_way_.back();
  try {
    // In front of the frame's own work, so that the two APIs take fewer turns on the device.
    // Lists that the host waits for come first: it would wait for its own queue.
    if (!checked) wait_released(image.external, stream_.get());
    launch_search(frame, report);
    if (checked) {
      launch_checked_lists(frame, report);
      wait_released(image.external, stream_.get());
    } else {
      launch_lists(frame, report);
    }
    DepthLimits limits;
    if (image.external.limited) limits = depth_limits(image.external, frame.limits.encoding);
    launch_image(raster_target(image.external, frame.background), limits, report);
    signal_rendered(image.external, stream_.get());
    copy(report);  // the host that waits for the image does not wait for this
    mark_end(image.external, stream_.get());
  } catch (...) {
    under_way_.pop_back();
    throw;
  }
}

bool SplatPipeline::finish(bool wait, FrameStats& stats) {
  if (under_way_.empty()) return false;
  device_->use();
  FrameReport& oldest = *under_way_.front();
  if (wait) oldest.wait();
  if (!oldest.passed()) return false;
  collect(oldest, stats);
  const SplatRoom used = room_for(oldest.counters());
  const auto ahead = [](size_t& wanted, size_t needed) {
    wanted = std::max(wanted, needed + needed / 8);
  };
  ahead(wanted_.slots, used.slots), ahead(wanted_.strips, used.strips);
  ahead(wanted_.pairs, used.pairs);
  free_.push_back(std::move(under_way_.front()));
  under_way_.pop_front();
  return true;
}

void SplatPipeline::collect(const FrameReport& report, FrameStats& stats) const {
  const SplatCounters& counted = report.counters();
  instances_.collect(report.instances(), stats);
  stats.splats = counted.splats;
  stats.pairs_before = counted.pairs_boxed;
  stats.pairs_after = counted.pairs;
  stats.pairs_dropped = dropped(counted, report.room);
  stats.pixels_evaluated = counted.evaluated;
  stats.pixels_blended = counted.blended;

  count_bytes(report, stats);
  report.timer.collect(stats);
}

// What each stage reads and writes of its own arrays; what siblings share of their parents
// is left out.
void SplatPipeline::count_bytes(const FrameReport& report, FrameStats& stats) const {
  const SplatCounters& counted = report.counters();
  const TileGrid& grid = report.grid;
  const uint64_t tiles = static_cast<uint64_t>(grid.columns) * static_cast<uint64_t>(grid.rows);
  const uint64_t offsets = tiles * bin_blocks(device_->multiprocessors()) * sizeof(uint32_t);
  const uint64_t pairs = counted.pairs;
  uint64_t candidates = 0;
  for (const InstanceCounters& instance : counted.instances) candidates += instance.candidates;
  constexpr uint64_t kRecord = sizeof(SplatRecord), kKey = sizeof(DepthKey);
  stats.gaussian_bytes = instances_.bytes_a_gaussian();
  stats.bytes[kProject] =
      uint64_t{counted.places} * instances_.bytes_a_place() + 2 * sizeof(uint32_t) * candidates +
      counted.splats * (stats.gaussian_bytes + kRecord) + counted.strips * sizeof(TileStrip);
  stats.bytes[kBin] = 2 * counted.strips * sizeof(TileStrip) + 2 * offsets + pairs * kKey;
  stats.bytes[kSort] = 2 * pairs * kKey;
  stats.bytes[kRasterize] = pairs * (kKey + kRecord) + report.target_bytes;
}

}  // namespace

std::unique_ptr<Pipeline> create_pipeline(std::shared_ptr<const Device> device,
                                          std::vector<DeviceInstance> instances,
                                          const PipelineDesc& desc) {
  return std::make_unique<SplatPipeline>(std::move(device), std::move(instances), desc);
}

}  // namespace voyager::cuda
