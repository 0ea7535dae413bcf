#include "tools/frame_bench.h"

#include <algorithm>
#include <numeric>

namespace voyager::tools {
namespace {

constexpr size_t kWarmUpFrames = 32;

size_t warm_up_frames(const FramePath& path) {
  return std::min(path.frames.size(), kWarmUpFrames);
}

size_t settling_frames(const FramePath& path) {
  const size_t frames = path.frames.size();
  return path.settles ? (kWarmUpFrames + frames - 1) / frames * frames : 0;
}

View make_view(const FrameMaker& maker, const PipelineDesc& desc) {
  return View(maker.scene, maker.backend, desc, std::pmr::get_default_resource(), maker.workers);
}

Image unseen_image(const FrameEye& eye) {
  Image image;
  image.format = ColorFormat::rgba8;
  image.width = eye.camera.width;
  image.height = eye.camera.height;
  return image;
}

FrameInput unseen(FrameInput frame) {
  for (FrameEye& eye : frame.eyes) eye.image = unseen_image(eye);
  return frame;
}

// The first frame tells whether the backend counts pixels at all.
bool counts_pixels(const FrameStats& stats) {
  return stats.pixels_evaluated > 0 || stats.pairs_after == 0;
}

}  // namespace

size_t FramePath::frames_drawn() const {
  const size_t passes = repeats + (counts_pixels ? 1 : 0);
  return warm_up_frames(*this) + 1 + settling_frames(*this) + frames.size() * passes;
}

FrameRun run_frames(const FrameMaker& maker, const PipelineDesc& desc, const FramePath& path,
                    const std::function<void(size_t)>& frame_done) {
  FrameRun run;
  size_t drawn = 0;
  const auto draw = [&](View& view, const FrameInput& frame) -> const FrameStats& {
    view.render(unseen(frame));
    frame_done(++drawn);
    return view.stats();
  };
  {
    View view = make_view(maker, desc);
    for (size_t i = 0; i < warm_up_frames(path); ++i) draw(view, path.frames[i]);
    draw(view, path.frames[0]);
    if (path.time_budget) view.set_time_budget(*path.time_budget, path.frames[0].tau);
    const auto steered = [&](size_t i) {
      FrameInput frame = path.frames[i % path.frames.size()];
      frame.tau = view.next_tau(frame.tau);
      return frame;
    };
    for (size_t i = 0; i < settling_frames(path); ++i) draw(view, steered(i));
    for (size_t i = 0; i < path.repeats * path.frames.size(); ++i)
      run.timed.push_back(draw(view, steered(i)));
    while (path.goes_on && path.goes_on())
      for (size_t i = 0; i < path.frames.size(); ++i) draw(view, steered(i));
  }
  if (path.time_budget || !path.counts_pixels) return run;
  PipelineDesc counting = desc;
  counting.count_pixels = true;
  View view = make_view(maker, counting);
  for (const FrameInput& frame : path.frames) {
    const FrameStats& stats = draw(view, frame);
    if (!counts_pixels(stats)) {
      run.counted.clear();
      break;
    }
    run.counted.push_back(stats);
  }
  return run;
}

RgbaImage draw_image(View& view, const FrameInput& frame) {
  Image image = unseen_image(frame.eyes[0]);
  RgbaImage pixels(size_t{4} * image.width * image.height);
  image.format = ColorFormat::rgba32f;
  image.color = pixels.data();
  image.color_pitch = pixel_bytes(image.format) * image.width;
  FrameInput seen = unseen(frame);
  seen.eyes[0].image = image;
  view.render(seen);
  return pixels;
}

std::vector<size_t> every_index(size_t count) {
  std::vector<size_t> all(count);
  std::iota(all.begin(), all.end(), size_t{0});
  return all;
}

std::vector<RgbaImage> draw_images(const FrameMaker& maker, const PipelineDesc& desc,
                                   const std::vector<FrameInput>& frames,
                                   const std::vector<size_t>& chosen) {
  View view = make_view(maker, desc);
  std::vector<RgbaImage> images;
  images.reserve(chosen.size());
  for (const size_t i : chosen) images.push_back(draw_image(view, frames[i]));
  return images;
}

}  // namespace voyager::tools
