#include "cuda/splat/baseline.h"

#include <optional>

#include "cuda/device/stage_timer.h"
#include "cuda/frame/frame_image.h"
#include "cuda/splat/baseline_launch.h"
#include "runtime/base/error.h"
#include "runtime/frame/instance.h"
#include "runtime/frame/project_params.h"

namespace voyager::cuda {
namespace {

class BaselinePipeline final : public Pipeline {
 public:
  BaselinePipeline(std::shared_ptr<const Device> device, MakeInstance make, const Scenes& scenes,
                   const PipelineDesc& desc, Workers& workers)
      : device_(std::move(device)),
        workers_(workers),
        desc_(desc),
        instances_(std::move(make), scenes, 1),
        places_(scenes.size()) {}

  // What it frees belongs to the device's context.
  ~BaselinePipeline() override { device_->use_quietly(); }

  void set_scenes(const Scenes& scenes, std::span<const size_t> from) override;
  void draw(const FrameInput& frame, FrameStats& stats) override;
  void resolve(const FrameInput& frame, FrameStats& stats) override {
    image_.resolve(frame.eyes[0].image, workers_, stats);
  }
  void read_cut(size_t instance, std::pmr::vector<uint32_t>& cut) const override {
    device_->use();
    instances_.all()[instance].draws->read_cut(cut);
  }
  bool cut_is_near() const override { return false; }

 private:
  uint32_t read_places(cudaStream_t stream);
  void launch_projections(const FrameInput& frame, BaselineFrame& work) const;
  void collect(unsigned long long pairs, FrameStats& stats) const;
  void fit_places(uint32_t places);
  void fit_pairs(unsigned long long pairs);
  void fit_scratch(const BaselineView& view);
  BaselineView view(const TileGrid& grid, uint32_t places, unsigned long long pairs) const;

  std::shared_ptr<const Device> device_;
  Workers& workers_;
  PipelineDesc desc_;
  DeviceInstances instances_;
  std::vector<uint32_t> places_;  // of each instance's list
  Buffer<BaselineSplat> splats_;
  Buffer<TileRange> rows_, columns_;
  Buffer<uint32_t> tile_counts_;
  Buffer<unsigned long long> pair_ends_;
  Buffer<unsigned long long> keys_, sorted_keys_;
  Buffer<uint32_t> values_, sorted_values_;
  Buffer<ulonglong2> tiles_;
  Buffer<uint32_t> splat_count_{1};
  Buffer<char> scratch_;
  FrameImage image_;
  std::optional<PinnedMemory> report_;  // made for the instances
  Stream stream_;
  StageTimer timer_{stream_};
};

// A frame that failed may still run, and read what is freed here.
void BaselinePipeline::set_scenes(const Scenes& scenes, std::span<const size_t> from) {
  std::vector<uint32_t> places(scenes.size());
  device_->use();
  stream_.wait();
  instances_.set_scenes(scenes, from);
  places_.swap(places);
  report_.reset();
}

template <class T>
void fit(Buffer<T>& buffer, size_t count) {
  if (buffer.size() >= count) return;
  buffer = {};
  buffer = Buffer<T>(count + count / 4);
}

void BaselinePipeline::fit_places(uint32_t places) {
  fit(splats_, places);
  fit(rows_, places);
  fit(columns_, places);
  fit(tile_counts_, places);
  fit(pair_ends_, places);
}

void BaselinePipeline::fit_pairs(unsigned long long pairs) {
  fit(keys_, pairs);
  fit(sorted_keys_, pairs);
  fit(values_, pairs);
  fit(sorted_values_, pairs);
}

void BaselinePipeline::fit_scratch(const BaselineView& of) {
  fit(scratch_, baseline_scratch(of));
}

BaselineView BaselinePipeline::view(const TileGrid& grid, uint32_t places,
                                    unsigned long long pairs) const {
  return {splats_.data(),
          rows_.data(),
          columns_.data(),
          tile_counts_.data(),
          pair_ends_.data(),
          keys_.data(),
          sorted_keys_.data(),
          values_.data(),
          sorted_values_.data(),
          tiles_.data(),
          splat_count_.data(),
          grid,
          places,
          pairs};
}

// Spins, and copies to pageable memory, as 3DGS does: it is what is measured.
template <class T>
T read_value(const T* from, cudaStream_t stream) {
  T value;
  check(cudaMemcpyAsync(&value, from, sizeof value, cudaMemcpyDeviceToHost, stream), "a count");
  check(cudaStreamSynchronize(stream), "a count");
  return value;
}

// Of all instances.
uint32_t BaselinePipeline::read_places(cudaStream_t stream) {
  uint32_t sum = 0;
  for (size_t i = 0; i < places_.size(); ++i) {
    const CutList list = instances_.all()[i].draws->view().list;
    sum += places_[i] = list.room == 0 ? 0 : read_value(list.size, stream);
  }
  return sum;
}

void BaselinePipeline::launch_projections(const FrameInput& frame, BaselineFrame& work) const {
  for (size_t i = 0; i < places_.size(); ++i) {
    const DeviceInstance& instance = instances_.all()[i];
    work.places = places_[i];
    work.gaussians = instance.view();
    work.draws = instance.draws->view();
    work.params = project_params(*instance.scene, instance_camera(frame, frame.eyes[0], i), desc_,
                                 instance_look(frame, i));
    launch_baseline_project(work);
    work.first += work.places;
  }
}

void BaselinePipeline::draw(const FrameInput& frame, FrameStats& stats) {
  const FrameEye& eye = frame.eyes[0];
  if (eye.limits.values != nullptr)
    throw Error(ErrorCode::unsupported,
                "depth limits: found some with 3dgs splatting, expected none");
  device_->use();
  if (!report_) report_.emplace(instances_.report_bytes());
  const TileGrid grid = tile_grid(eye.camera.width, eye.camera.height);
  fit(tiles_, static_cast<size_t>(grid.columns) * static_cast<size_t>(grid.rows));
  image_.fit(eye);
  const RasterTarget target = image_.target(eye, frame.background);
  const cudaStream_t stream = stream_.get();
  const SceneReading reading(instances_, stream);
  timer_.begin();
  instances_.update(frame, stream);
  for (const DeviceInstance& instance : instances_.all()) instance.draws->weigh(stream);
  const uint32_t places = read_places(stream);
  timer_.end(kSearch);
  fit_places(places);
  BaselineFrame work{};
  work.view = view(grid, places, 0);
  work.stream = stream;
  fit_scratch(work.view);
  work.scratch = scratch_.data(), work.scratch_bytes = scratch_.bytes();
  launch_projections(frame, work);
  timer_.end(kProject);
  launch_baseline_scan(work);
  const unsigned long long pairs =
      places == 0 ? 0 : read_value(pair_ends_.data() + places - 1, stream);
  fit_pairs(pairs);
  work.view = view(grid, places, pairs);
  fit_scratch(work.view);
  work.scratch = scratch_.data(), work.scratch_bytes = scratch_.bytes();
  launch_baseline_keys(work);
  timer_.end(kBin);
  launch_baseline_sort(work);
  timer_.end(kSort);
  launch_baseline_rasterize(work, instances_.siblings(), target);
  timer_.end(kRasterize);
  if (image_.fetch(eye.image, stream)) timer_.end(kResolve);
  launch_baseline_count(work);
  instances_.report(report_->data(), stream);
  stats.splats = read_value(splat_count_.data(), stream);
  stats.gaussian_bytes = instances_.bytes_a_gaussian();
  collect(pairs, stats);
}

void BaselinePipeline::collect(unsigned long long pairs, FrameStats& stats) const {
  instances_.collect(report_->data(), stats);
  stats.pairs_before = stats.pairs_after = pairs;
  timer_.collect(stats);
}

}  // namespace

std::unique_ptr<Pipeline> create_baseline_pipeline(std::shared_ptr<const Device> device,
                                                   MakeInstance make, const Scenes& scenes,
                                                   const PipelineDesc& desc, Workers& workers) {
  if (desc.eyes != 1)
    throw Error(ErrorCode::unsupported,
                "eyes: found " + std::to_string(desc.eyes) + ", expected 1 with 3dgs splatting");
  if (desc.exponential != Exponential::exact)
    throw Error(ErrorCode::unsupported,
                "exponential: found another than exact with 3dgs splatting, expected exact");
  if (desc.antialias == Antialias::truth)
    throw Error(ErrorCode::unsupported,
                "antialias: found the truth's samples with 3dgs splatting, expected on or off");
  return std::make_unique<BaselinePipeline>(std::move(device), std::move(make), scenes, desc,
                                            workers);
}

}  // namespace voyager::cuda
