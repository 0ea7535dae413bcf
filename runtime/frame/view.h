#pragma once
// A view: one scene seen through one backend, with what it keeps between frames.
#include <memory>

#include "runtime/frame/backend.h"

namespace voyager {

class View {
 public:
  View(std::shared_ptr<const Scene> scene, Backend& backend, const PipelineDesc& desc,
       std::pmr::memory_resource* memory, Workers& workers);

  // Runs the stages and fills the image. Throws Error(damaged_chunk) where the
  // frame needs one, Error(invalid_argument) for a camera that METHOD §3
  // excludes; the image is untouched then.
  void render(const FrameInput& frame, const Image& image);

  bool draws_cut() const { return !scene_->flat() && desc_.lod == Lod::cut; }
  bool has_frame() const { return frames_ > 0; }
  const FrameStats& stats() const { return stats_; }
  // Of the last frame that was drawn, as stats() is: a frame that threw leaves both.
  // Throws Error(unsupported) where the cut was on a device and a later frame threw.
  const std::pmr::vector<uint32_t>& cut();

 private:
  // Whether the frame's cut is now in cut_.
  bool read_changes(bool follows, FrameStats& stats);

  std::shared_ptr<const Scene> scene_;
  PipelineDesc desc_;
  std::unique_ptr<Pipeline> pipeline_;
  std::pmr::vector<uint32_t> cut_;       // scratch
  std::pmr::vector<uint32_t> last_cut_;  // of the last frame that succeeded, if it was read
  bool cut_read_ = true;
  FrameStats stats_;
  uint64_t frames_ = 0;
  bool follows_ = true;  // no frame has failed since the last that succeeded
};

}  // namespace voyager
