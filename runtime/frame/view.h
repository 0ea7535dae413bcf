#pragma once
// A view: instances of scenes seen through one backend, with what it keeps between frames.
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/frame/backend.h"
#include "runtime/frame/frame_streaming.h"
#include "runtime/frame/time_budget.h"

namespace voyager {

class View {
 public:
  // scenes: one an instance, up to kMaxInstances.
  // clock: what a viewer's velocity is measured by; none: the machine's.
  View(Scenes scenes, Backend& backend, const PipelineDesc& desc, std::pmr::memory_resource* memory,
       Workers& workers, Clock clock = {});
  View(std::shared_ptr<const Scene> scene, Backend& backend, const PipelineDesc& desc,
       std::pmr::memory_resource* memory, Workers& workers, Clock clock = {})
      : View(Scenes{std::move(scene)}, backend, desc, memory, workers, std::move(clock)) {}

  // The instances from the next frame on. Waits for the frames in flight. The k-th instance of a
  // scene goes on with what the k-th of this scene has kept, and what nobody goes on with is freed.
  // Where it throws, as the constructor may, nothing has changed.
  void set_scenes(Scenes scenes);

  // Runs the stages and fills the images, all in host memory or all of another API. The frame
  // has no pose, or one an instance, and no look, or one an instance. Throws Error(damaged_chunk)
  // where the frame needs one, Error(invalid_argument) for a camera that METHOD §3 excludes in any
  // scene's coordinates; the images are untouched then.
  void render(const FrameInput& frame);
  // Of one eye.
  void render(FrameInput frame, const Image& image) {
    frame.eyes[0].image = image;
    render(frame);
  }

  // The times of frames steer τ from now on. A first budget starts at tau.
  void set_time_budget(const TimeBudgetDesc& desc, double tau);
  void end_time_budget() { budget_.reset(); }
  // What the next frame's tau is to be: `chosen` without a budget. Once a frame.
  double next_tau(double chosen);

  size_t instances() const { return scenes_.size(); }
  bool draws_cut(size_t instance) const {
    return !scenes_[instance]->flat() && voyager::draws_cut(desc_.lod);
  }
  // Whether τ may come to matter: scenes with trees may come.
  bool may_draw_cut() const { return voyager::draws_cut(desc_.lod); }
  bool draws_any_cut() const;
  bool has_frame() const { return frames_ > 0; }
  // Whether a frame has been drawn since the instances are what they are.
  bool has_cuts() const { return drawn_; }
  // Of the last frame that has ended; a frame into another API's image may still be in flight.
  // Waits where none has. pairs_dropped is also that of frames before it that nobody asked about.
  const FrameStats& stats();
  // What the view does without, its scenes' own omissions first; each scene's once. As far as the
  // frames so far tell.
  std::vector<Omission> omissions() const;
  // An instance's of the last frame that was drawn, for which it waits; has_cuts(). A frame that
  // threw leaves both.
  // Throws Error(unsupported) where the cut was on a device and a later frame threw.
  const std::pmr::vector<uint32_t>& cut(size_t instance = 0);

 private:
  struct InstanceCut {
    explicit InstanceCut(std::pmr::memory_resource* memory) : cut(memory), last(memory) {}
    std::pmr::vector<uint32_t> cut;   // scratch
    std::pmr::vector<uint32_t> last;  // of the last frame that succeeded, if it was read
    bool read = true;
  };

  // Of a frame into another API's image.
  struct UnderWay {
    FrameStats stats;
    bool changes_known = false;  // entered and left are there already
  };

  FrameStats known_stats(const FrameInput& frame);
  void draw(const FrameInput& frame, bool follows);
  void keep_stats(const FrameStats& stats);
  void submit(const FrameInput& frame, bool follows);
  // Whether one ended.
  bool finish_one(bool wait);
  // Whether the frame's cuts are now in cuts_.
  bool read_changes(bool follows, FrameStats& stats);
  bool try_read_changes(FrameStats& stats);
  void keep_cuts(bool read);

  Scenes scenes_;
  std::pmr::memory_resource* memory_;
  std::unique_ptr<FrameStreaming> streaming_;
  PipelineDesc desc_;
  std::unique_ptr<Pipeline> pipeline_;
  std::vector<InstanceCut> cuts_;
  std::optional<TimeBudget> budget_;
  FrameStats stats_;
  std::deque<UnderWay> under_way_;  // the oldest first
  bool ended_ = false;              // stats_ is a frame's
  bool heard_ = true;               // stats_ was asked for
  uint64_t frames_ = 0;
  bool drawn_ = false;   // a frame of these instances
  bool follows_ = true;  // no frame has failed since the last that succeeded
};

}  // namespace voyager
