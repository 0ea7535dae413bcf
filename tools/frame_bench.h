#pragma once
// Runs one configuration of a frame along a camera path.
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/frame/backend.h"
#include "runtime/frame/time_budget.h"
#include "runtime/frame/view.h"
#include "tools/metrics/image_error.h"

namespace voyager::tools {

struct FramePath {
  std::vector<FrameInput> frames;  // not empty
  size_t repeats = 1;              // how often the path is timed, end to start at once
  std::optional<TimeBudgetDesc> time_budget =
      {};                     // it chooses timed frames' tau, from the first's on
  bool counts_pixels = true;  // in a pass of its own
  bool settles = false;       // the path is drawn under the budget before it is timed
  // Where given, the path is drawn on after it was timed, whole, for as long as it says so.
  std::function<bool()> goes_on = {};

  // Frames that run_frames() draws, at most, before what goes_on asks for.
  size_t frames_drawn() const;
};

struct FrameRun {
  std::vector<FrameStats> timed;  // path after path
  // The path once, with pixel counts; none where not counted, and under a time budget.
  std::vector<FrameStats> counted;
};

struct FrameMaker {
  Backend& backend;
  std::shared_ptr<const Scene> scene;
  Workers& workers;
};

// Images are 8-bit and handed to nobody. After a start on the path's first 32 frames and
// on the first again, each camera in order. To settle is to draw the path, whole, until that is 32
// frames or more. frame_done(frames drawn so far) follows each.
// Throws Error(unsupported) for a choice that the backend lacks.
FrameRun run_frames(const FrameMaker& maker, const PipelineDesc& desc, const FramePath& path,
                    const std::function<void(size_t)>& frame_done);

// The view's next frame, of two eyes the left, as floats before clamping.
RgbaImage draw_image(View& view, const FrameInput& frame);
// 0 to count − 1: all of so many frames.
std::vector<size_t> every_index(size_t count);
// The chosen frames, by a view of their own.
std::vector<RgbaImage> draw_images(const FrameMaker& maker, const PipelineDesc& desc,
                                   const std::vector<FrameInput>& frames,
                                   const std::vector<size_t>& chosen);

}  // namespace voyager::tools
