#include "cuda/frame/pipeline.h"

#include <algorithm>
#include <array>
#include <deque>
#include <vector>

#include "cuda/device/range.h"
#include "cuda/frame/frame_image.h"
#include "cuda/frame/frame_limits.h"
#include "cuda/frame/frame_report.h"
#include "cuda/frame/shown_report.h"
#include "cuda/interop/external_ring.h"
#include "cuda/splat/occlusion.h"
#include "cuda/splat/splat_state.h"
#include "cuda/stream/device_pool.h"
#include "runtime/base/error.h"
#include "runtime/frame/choice_omission.h"
#include "runtime/frame/instance.h"
#include "runtime/frame/project_params.h"
#include "runtime/math/alpha_lut.h"

namespace voyager::cuda {
namespace {

// A stream takes some thousand launches ahead of the device: in the next launch the host would
// sleep until the device goes on, which may wait for the host. So would every thread that wants
// memory of the device. A frame has up to twenty launches for each instance, and 24 times 20 are
// half of a thousand.
constexpr size_t kInstancesAhead = 24;

Buffer<float> upload_lut(const PipelineDesc& desc) {
  if (desc.exponential != Exponential::lut) return {};
  std::vector<float> lut(desc.lut_size + 1);
  fill_alpha_lut(desc.lut_size, lut.data());
  return upload(std::span<const float>(lut));
}

template <class Work>
void run_stage(Stage stage, FrameReport& report, const Work& work) {
  const Range range(kStageNames[stage]);
  work();
  report.timer.end(stage);
}

class SplatPipeline final : public Pipeline {
 public:
  SplatPipeline(std::shared_ptr<const Device> device, MakeInstance make, const Scenes& scenes,
                const PipelineDesc& desc, Workers& workers)
      : device_(std::move(device)),
        workers_(workers),
        instances_(std::move(make), scenes, desc.eyes),
        desc_(desc),
        lut_(upload_lut(desc)),
        splats_(bin_blocks(device_->multiprocessors()), desc.eyes),
        images_(desc.eyes),
        limits_(desc.eyes),
        shown_(device_),
        occlusion_choice_(desc.count_pixels ? Occlusion::off : desc.occlusion) {}

  // What it frees belongs to the device's context, and to frames that may be in flight.
  ~SplatPipeline() override {
    device_->use_quietly();
    stream_.wait_quietly();
  }

  void set_scenes(const Scenes& scenes, std::span<const size_t> from) override;
  void draw(const FrameInput& frame, FrameStats& stats) override;
  void resolve(const FrameInput& frame, FrameStats& stats) override {
    for (size_t eye = 0; eye < images_.size(); ++eye)
      images_[eye].resolve(frame.eyes[eye].image, workers_, stats);
  }
  void submit(const FrameInput& frame, bool checked) override;
  bool finish(bool wait, FrameStats& stats) override;
  bool counts_changes() const override { return instances_.counts_changes(); }
  void read_cut(size_t instance, std::pmr::vector<uint32_t>& cut) const override {
    device_->use();
    instances_.all()[instance].draws->read_cut(cut);
  }
  const ShownChunks* shown_chunks(size_t instance) const override { return shown_.of(instance); }
  bool cut_is_near() const override { return false; }
  std::vector<Omission> omissions() const override;

 private:
  using Report = std::unique_ptr<FrameReport>;

  using Eyes = std::array<RasterEye, kMaxEyes>;

  void wait_for_frames();
  void await_links() const;
  void bound_launches() const;
  Report begin_frame(const FrameInput& frame);
  void fit(const FrameInput& frame, const FrameTiles& tiles);
  // SceneReading: that of the frame, which has not ended.
  void launch_search(const SceneReading&, const FrameInput& frame, FrameReport& report);
  SplatFrame work(const FrameTiles& tiles, int pass) const;
  void launch_lists(const SceneReading& reading, const FrameInput& frame, FrameReport& report);
  void launch_checked_lists(const SceneReading& reading, const FrameInput& frame,
                            FrameReport& report);
  void launch_projections(const SceneReading&, const FrameInput& frame, SplatFrame& work);
  static Eyes external_eyes(const FrameInput& frame);
  RasterChoices raster_choices() const;
  void launch_told(const FrameInput& frame, const FrameReport& report);
  void launch_image(const SceneReading& reading, const FrameInput& frame, const Eyes& eyes,
                    FrameReport& report);
  void launch_fetch(const FrameInput& frame, FrameReport& report);
  void launch_second_pass(const SceneReading& reading, const FrameInput& frame,
                          const RasterChoices& choices, const Eyes& eyes, FrameReport& report);
  void copy(FrameReport& report) const {
    report.copy(splats_.counters(), instances_, stream_.get());
  }
  void make_room();
  static void draw_again(FrameReport& report);
  void collect(const FrameReport& report, FrameStats& stats) const;
  uint64_t culling_bytes(const SplatCounters& counted) const;
  void learn(const FrameReport& report);
  void count_bytes(const FrameReport& report, FrameStats& stats) const;

  std::shared_ptr<const Device> device_;
  Workers& workers_;
  DeviceInstances instances_;
  PipelineDesc desc_;
  Buffer<float> lut_;
  SplatState splats_;
  std::vector<FrameImage> images_;  // of each eye, as limits
  std::vector<FrameLimits> limits_;
  ShownReport shown_;
  OcclusionState occlusion_;
  OcclusionChoice occlusion_choice_;
  Stream stream_;
  std::vector<Report> free_;      // made as many as were in flight at once
  std::deque<Report> under_way_;  // the oldest first
  Event begun_{kWaitedFor};       // passed once the host has let go of the last one's images
  SplatRoom wanted_;              // by what frames that were in flight have used
};

// A frame that failed may still run, and read what is freed here. Reports have the room that the
// instances need, so they are made anew.
void SplatPipeline::set_scenes(const Scenes& scenes, std::span<const size_t> from) {
  device_->use();
  wait_for_host(stream_);
  instances_.set_scenes(scenes, from);
  free_.clear();
}

// One instance after the other, so that each finds on the device where its ranks and slots begin.
void SplatPipeline::launch_projections(const SceneReading&, const FrameInput& frame,
                                       SplatFrame& work) {
  for (size_t i = 0; i < instances_.all().size(); ++i) {
    const DeviceInstance& instance = instances_.all()[i];
    work.gaussians = instance.view();
    work.draws = instance.draws->view();
    for (uint32_t eye = 0; eye < desc_.eyes; ++eye)
      work.params[eye] = project_params(*instance.scene, instance_camera(frame, frame.eyes[eye], i),
                                        desc_, instance_look(frame, i));
    work.rows = launch_rows(work);
    // All of them, so that a second pass has them, too.
    if (!work.draws.weights.weighs() && work.splats.open_parts == nullptr)
      instance.draws->weigh(stream_.get());
    if (launch_project(work, desc_.alpha_filter)) ++work.instance;
  }
}

SplatFrame SplatPipeline::work(const FrameTiles& tiles, int pass) const {
  SplatFrame work{};
  work.splats = splats_.view(tiles, pass);
  if (pass == 0) work.splats.limits = occlusion_.first();
  work.multiprocessors = device_->multiprocessors();
  work.stream = stream_.get();
  return work;
}

// Up to the tiles' lists.
void SplatPipeline::launch_lists(const SceneReading& reading, const FrameInput& frame,
                                 FrameReport& report) {
  report.room = splats_.room();
  splats_.begin_frame(report.tiles, stream_.get());
  SplatFrame lists = work(report.tiles, 0);
  run_stage(kProject, report, [&] { launch_projections(reading, frame, lists); });
  run_stage(kBin, report, [&] { launch_bin(lists); });
  run_stage(kSort, report, [&] { launch_sort(lists); });
}

void SplatPipeline::draw_again(FrameReport& report) {
  report.timer.go_back_to(kSearch);
  ++report.redraws;
}

// Lists that found too little room are made again with more.
void SplatPipeline::launch_checked_lists(const SceneReading& reading, const FrameInput& frame,
                                         FrameReport& report) {
  for (;;) {
    launch_lists(reading, frame, report);
    copy(report);
    report.wait();
    if (!splats_.grow(room_for(report.counters()))) return;
    draw_again(report);
  }
}

RasterChoices SplatPipeline::raster_choices() const {
  return {desc_.exponential,
          desc_.alpha_filter,
          desc_.count_pixels,
          instances_.siblings(),
          lut_.data(),
          desc_.lut_size,
          log_threshold(desc_.antialias)};
}

void SplatPipeline::launch_image(const SceneReading& reading, const FrameInput& frame,
                                 const Eyes& eyes, FrameReport& report) {
  const RasterChoices choices = raster_choices();
  run_stage(kRasterize, report, [&] {
    launch_rasterize(work(report.tiles, 0), choices, eyes.data());
    if (occlusion_.limited()) launch_second_pass(reading, frame, choices, eyes, report);
  });
}

// Behind the image, which does not wait for it. Reads nothing of a scene.
void SplatPipeline::launch_told(const FrameInput& frame, const FrameReport& report) {
  if (report.tells)
    shown_.launch(instances_, splats_.view(report.tiles, 0), frame, raster_choices(),
                  stream_.get());
}

// What resolve() hands on.
void SplatPipeline::launch_fetch(const FrameInput& frame, FrameReport& report) {
  const Range range(kStageNames[kResolve]);
  bool fetches = false;
  for (uint32_t eye = 0; eye < desc_.eyes; ++eye)
    fetches = images_[eye].fetch(frame.eyes[eye].image, stream_.get()) || fetches;
  if (fetches) report.timer.end(kResolve);
}

// All stages, for the tiles that the first pass left open. Without any, each kernel ends at once.
void SplatPipeline::launch_second_pass(const SceneReading& reading, const FrameInput& frame,
                                       const RasterChoices& choices, const Eyes& eyes,
                                       FrameReport& report) {
  const Range range("second pass");
  SplatFrame rest = work(report.tiles, 1);
  rest.splats.limits = occlusion_.second(rest.splats, stream_.get());
  launch_projections(reading, frame, rest);
  launch_bin(rest);
  launch_sort(rest);
  launch_rasterize(rest, choices, eyes.data());
}

// Before a frame that the host will wait for: frames in flight may wait for the host, those of
// other views too, behind which a pool's chunks were linked.
void SplatPipeline::wait_for_frames() {
  device_->use();
  wait_for_host(stream_);
  await_links();
}

void SplatPipeline::await_links() const {
  for (const DeviceInstance& instance : instances_.all())
    if (instance.scene->streamed()) pool_of(*instance.scene, *device_).await_links();
}

// Of this frame and those in flight, if they have more than kInstancesAhead together: none of them
// waits for the host any more in front of its lists.
void SplatPipeline::bound_launches() const {
  const size_t frames = under_way_.size() + 1;
  if (frames * instances_.all().size() <= kInstancesAhead) return;
  device_->use();
  wait_for_host(begun_);
  await_links();
}

SplatPipeline::Report SplatPipeline::begin_frame(const FrameInput& frame) {
  for (const FrameEye& eye : frame.eyes)
    if (desc_.count_pixels && (eye.limits.values != nullptr || eye.image.external.limited))
      throw Error(ErrorCode::unsupported,
                  "depth limits: found some, pixels are counted of frames without");
  device_->use();
  make_room();
  const FrameTiles tiles = frame_tiles(frame);
  fit(frame, tiles);  // while nothing is taken that would be freed beside a frame in flight
  Report report;
  if (free_.empty()) {
    report = std::make_unique<FrameReport>(stream_, instances_);
  } else {
    report = std::move(free_.back());
    free_.pop_back();
  }
  report->redraws = 0;
  const auto tells = [](const Report& other) { return other->tells; };
  report->tells =
      std::none_of(under_way_.begin(), under_way_.end(), tells) && shown_.wanted(instances_);
  report->tiles = tiles;
  report->target_bytes = 0;
  for (const FrameEye& eye : frame.eyes)
    report->target_bytes +=
        uint64_t{eye.image.width} * eye.image.height * pixel_bytes(eye.image.format);
  return report;
}

// To the frame's size. What is too small is replaced, and frames in flight still use it.
void SplatPipeline::fit(const FrameInput& frame, const FrameTiles& tiles) {
  bool fits = splats_.fits(tiles) && shown_.fits(instances_) &&
              (!occlusion_choice_.possible() || occlusion_.fits(tiles));
  for (size_t eye = 0; eye < frame.eyes.size(); ++eye)
    fits = fits && limits_[eye].fits(frame.eyes[eye]) && images_[eye].fits(frame.eyes[eye]);
  if (fits) return;
  wait_for_host(stream_);
  if (!splats_.fits(tiles)) occlusion_.forget();  // the ends that it knows are in these
  splats_.fit(tiles);
  for (const Report& report : under_way_) report->tells = false;  // what they copied goes
  shown_.fit(instances_);
  if (occlusion_choice_.possible()) occlusion_.fit(tiles);
  for (size_t eye = 0; eye < frame.eyes.size(); ++eye) {
    limits_[eye].fit(frame.eyes[eye]);
    images_[eye].fit(frame.eyes[eye]);
  }
}

void SplatPipeline::launch_search(const SceneReading&, const FrameInput& frame,
                                  FrameReport& report) {
  report.timer.begin();
  run_stage(kSearch, report, [&] {
    // Reads where the tiles of the frame before ended, which begin_frame() of the splats clears.
    occlusion_.begin(occlusion_choice_.next(), frame, report.tiles,
                     splats_.view(report.tiles, 0).ends, stream_.get());
    report.limited = occlusion_.limited();
    // Lists with limits lack what is hidden. Nor may telling change them: a frame that is not drawn
    // again has no room for more than what such frames had.
    report.tells = report.tells && !report.limited;
    instances_.update(frame, stream_.get());
  });
}

// Frames that are left in flight cannot be drawn again: they get room before they need it.
void SplatPipeline::make_room() {
  if (!splats_.room().holds(wanted_)) {
    wait_for_host(stream_);
    splats_.grow(wanted_);
  }
  wanted_ = {};
}

void SplatPipeline::draw(const FrameInput& frame, FrameStats& stats) {
  wait_for_frames();
  Report report = begin_frame(frame);
  Eyes eyes{};
  for (uint32_t eye = 0; eye < desc_.eyes; ++eye)
    eyes[eye].target = images_[eye].target(frame.eyes[eye], frame.background);
  const SceneReading reading(instances_, stream_.get());
  launch_search(reading, frame, *report);
  for (uint32_t eye = 0; eye < desc_.eyes; ++eye)
    eyes[eye].limits = limits_[eye].upload(frame.eyes[eye], stream_.get());
  for (;;) {
    launch_lists(reading, frame, *report);
    launch_image(reading, frame, eyes, *report);
    launch_fetch(frame, *report);
    launch_told(frame, *report);
    copy(*report);
    report->wait();
    if (!splats_.grow(room_for(report->counters()))) break;
    draw_again(*report);
  }
  collect(*report, stats);
  shown_.collect(report->tells);
  learn(*report);
  free_.push_back(std::move(report));
}

// The eyes' targets may be layers of one image.
template <class Work>
void each_ring(const FrameInput& frame, const Work& work) {
  const ExternalRing* before = nullptr;
  for (const FrameEye& eye : frame.eyes) {
    if (eye.image.external.ring != before) work(eye.image.external);
    before = eye.image.external.ring;
  }
}

// What was launched of a frame that fails may still write to its images.
void mark_end_quietly(const FrameInput& frame, cudaStream_t stream) noexcept {
  try {
    each_ring(frame, [&](const ExternalTarget& target) { mark_end(target, stream); });
  } catch (const std::exception&) {
    return;  // a device that is lost writes nothing more
  }
}

SplatPipeline::Eyes SplatPipeline::external_eyes(const FrameInput& frame) {
  Eyes eyes{};
  for (size_t i = 0; i < frame.eyes.size(); ++i) {
    const FrameEye& eye = frame.eyes[i];
    const ExternalTarget& external = eye.image.external;
    eyes[i].target = raster_target(external, frame.background);
    if (external.limited) eyes[i].limits = depth_limits(external, eye.limits.encoding);
  }
  return eyes;
}

void SplatPipeline::submit(const FrameInput& frame, bool checked) {
  if (checked) wait_for_frames();
  bound_launches();
  under_way_.push_back(begin_frame(frame));
  const cudaStream_t stream = stream_.get();
  const auto wait = [&] {
    each_ring(frame, [&](const ExternalTarget& target) { wait_released(target, stream); });
    begun_.record(stream);
  };
  FrameReport& report = *under_way_.back();
  try {
    // In front of the frame's own work, so that the two APIs take fewer turns on the device.
    // Lists that the host waits for come first, or that the stream does not take: the host would
    // wait for its own queue.
    const bool lists_first = checked || instances_.all().size() > kInstancesAhead;
    if (!lists_first) wait();
    {
      const SceneReading reading(instances_, stream);
      launch_search(reading, frame, report);
      checked ? launch_checked_lists(reading, frame, report) : launch_lists(reading, frame, report);
      if (lists_first) {
        wait();
        report.timer.leave_out();
      }
      launch_image(reading, frame, external_eyes(frame), report);  // a second pass reads, too
    }
    each_ring(frame, [&](const ExternalTarget& target) { signal_rendered(target, stream); });
    launch_told(frame, report);
    copy(report);  // the host that waits for the image does not wait for this
    each_ring(frame, [&](const ExternalTarget& target) { mark_end(target, stream); });
  } catch (...) {
    mark_end_quietly(frame, stream);
    free_.push_back(std::move(under_way_.back()));  // to free it would be to wait for the host
    under_way_.pop_back();
    throw;
  }
}

bool SplatPipeline::finish(bool wait, FrameStats& stats) {
  if (under_way_.empty()) return false;
  device_->use();
  FrameReport& oldest = *under_way_.front();
  if (wait) oldest.wait_for_host();
  if (!oldest.passed()) return false;
  collect(oldest, stats);
  shown_.collect(oldest.tells);
  learn(oldest);
  SplatRoom used = room_for(oldest.counters());
  // The device counts slots only for places that had room.
  if (oldest.room.places != 0 && used.places > oldest.room.places)
    used.slots = used.slots * used.places / oldest.room.places;
  const auto ahead = [](size_t& wanted, size_t needed) {
    wanted = std::max(wanted, needed + needed / 8);
  };
  ahead(wanted_.places, used.places), ahead(wanted_.slots, used.slots);
  ahead(wanted_.strips, used.strips), ahead(wanted_.pairs, used.pairs);
  free_.push_back(std::move(under_way_.front()));
  under_way_.pop_front();
  return true;
}

void SplatPipeline::collect(const FrameReport& report, FrameStats& stats) const {
  instances_.collect(report.instances(), stats);
  for (const SplatCounters& counted : report.counters()) {
    stats.splats += counted.splats;
    stats.pairs_before += counted.pairs_boxed;
    stats.pairs_after += counted.pairs;
    stats.pixels_evaluated += counted.evaluated;
    stats.pixels_blended += counted.blended;
    stats.places_read += counted.places_read;
    stats.tiles_redrawn += counted.open.count;
  }
  stats.pairs_dropped = dropped(report.counters(), report.room);
  stats.redraws = report.redraws;
  count_bytes(report, stats);
  report.timer.collect(stats);
}

void SplatPipeline::learn(const FrameReport& report) {
  uint64_t pairs = 0;
  for (const SplatCounters& counted : report.counters()) pairs += counted.pairs;
  occlusion_choice_.learn(report.limited, pairs);
}

// Bytes that culling reads: of the rows of a list, and of the places of those that it keeps.
uint64_t SplatPipeline::culling_bytes(const SplatCounters& counted) const {
  uint64_t bytes = 0;
  const InstanceCounters* of = counted.instances;
  for (const DeviceInstance& instance : instances_.all()) {
    const CutList list = instance.draws->view().list;
    if (list.room == 0) continue;
    const uint64_t all = of[1].first_rank - of[0].first_rank;
    const bool bounded = list.bounds != nullptr;
    bytes += (bounded ? uint64_t{of->rows} * kRowPlaces : all) * instances_.bytes_a_place();
    if (bounded) bytes += all / kRowPlaces * sizeof(MeanBounds);
    ++of;
  }
  return bytes;
}

// What each stage reads and writes of its own arrays; what siblings share of their parents
// is left out, and a Gaussian is read once for all eyes, which see about the same ones. All of a
// second pass counts as the stages' own, though its time is rasterize's.
void SplatPipeline::count_bytes(const FrameReport& report, FrameStats& stats) const {
  // A block of bin has one eye's.
  const uint64_t offsets = uint64_t{report.tiles.count()} * bin_blocks(device_->multiprocessors()) *
                           sizeof(uint32_t) / desc_.eyes;
  constexpr uint64_t kRecord = sizeof(SplatRecord), kKey = sizeof(DepthKey);
  stats.gaussian_bytes = instances_.bytes_a_gaussian();
  for (const SplatCounters& counted : report.counters()) {
    if (counted.places == 0) continue;
    const uint64_t pairs = counted.pairs, rows = counted.places / kRowPlaces;
    uint64_t candidates = 0;
    for (const InstanceCounters& instance : counted.instances)
      candidates += instance.whole + instance.blended;
    stats.bytes[kProject] += culling_bytes(counted) +
                             2 * (sizeof(Candidate) * candidates + sizeof(RankRow) * rows) +
                             counted.splats * (stats.gaussian_bytes / desc_.eyes + kRecord) +
                             counted.strips * sizeof(TileStrip);
    stats.bytes[kBin] += 2 * counted.strips * sizeof(TileStrip) +
                         (counted.open.few() ? 0 : 2 * offsets) + pairs * kKey;
    stats.bytes[kSort] += 2 * pairs * kKey;
    stats.bytes[kRasterize] += pairs * (kKey + kRecord);
  }
  stats.bytes[kRasterize] += report.target_bytes;
}

std::vector<Omission> SplatPipeline::omissions() const {
  ViewShape shape;
  shape.eyes = desc_.eyes;
  for (const FrameImage& image : images_) {
    shape.pixels = std::max(shape.pixels, image.pixels());
    shape.depth = shape.depth || image.depth();
  }
  shape.eye_bytes = splats_.room().slots * sizeof(SplatRecord);
  ViewChoices choices{desc_, false, sizeof(float)};
  for (const FrameLimits& limits : limits_) choices.limits = choices.limits || limits.any();
  std::vector<Omission> all = instances_.omissions();
  for (const auto& more : {omissions_of(shape), omissions_of(choices, shape)})
    all.insert(all.end(), more.begin(), more.end());
  // Of kernels that are compiled without: registers and instructions, no memory.
  if (!instances_.siblings() && !desc_.count_pixels)
    all.push_back({"weights of siblings", "nothing that is drawn has a parent", 0, 0});
  if (!desc_.count_pixels)
    all.push_back({"counting of pixels", "no measurement asked for it", 0, 0});
  return all;
}

}  // namespace

std::unique_ptr<Pipeline> create_pipeline(std::shared_ptr<const Device> device, MakeInstance make,
                                          const Scenes& scenes, const PipelineDesc& desc,
                                          Workers& workers) {
  return std::make_unique<SplatPipeline>(std::move(device), std::move(make), scenes, desc, workers);
}

}  // namespace voyager::cuda
