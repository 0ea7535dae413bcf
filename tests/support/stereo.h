#pragma once
// Frames of two eyes.
#include <array>
#include <vector>

#include "tests/support/render_scene.h"

namespace voyager::test {

using EyeFrames = std::array<Frame, 2>;

// The pair's statistics and cut are in both.
inline EyeFrames render_stereo(View& view, FrameInput input) {
  EyeFrames frames;
  for (size_t i = 0; i < 2; ++i) {
    FrameEye& eye = input.eyes[i];
    Frame& frame = frames[i];
    frame.width = eye.camera.width, frame.height = eye.camera.height;
    const size_t pixels = size_t{frame.width} * frame.height;
    frame.rgba.assign(4 * pixels, NAN);  // what is left unwritten shows
    if (eye.depth_wanted) frame.depth.assign(pixels, NAN);
    eye.image.format = ColorFormat::rgba32f;
    eye.image.width = frame.width, eye.image.height = frame.height;
    eye.image.color = frame.rgba.data();
    eye.image.color_pitch = size_t{16} * frame.width;
    eye.image.depth = eye.depth_wanted ? frame.depth.data() : nullptr;
    eye.image.depth_pitch = size_t{4} * frame.width;
  }
  view.render(input);
  for (Frame& frame : frames) {
    frame.stats = view.stats();
    frame.cut.assign(view.cut().begin(), view.cut().end());
  }
  return frames;
}

inline EyeFrames render_stereo(Backend& backend, std::shared_ptr<const Scene> scene,
                               PipelineDesc desc, const FrameInput& input) {
  Workers workers;
  desc.eyes = 2;
  View view(std::move(scene), backend, desc, std::pmr::get_default_resource(), workers);
  return render_stereo(view, input);
}

inline FrameInput stereo_input(const Camera& left, const Camera& right, double tau) {
  FrameInput input = frame_input(left, tau);
  input.eyes.push_back(frame_input(right, tau).eyes[0]);
  return input;
}

// One of the pair, as a frame of its own.
inline FrameInput one_eye(const FrameInput& pair, size_t eye) {
  FrameInput input = pair;
  input.eyes = {pair.eyes[eye]};
  return input;
}

// Frusta off the centre, as headsets have them: mirror images of one another.
inline FrameInput headset_pair(const Vec3d& left, const Vec3d& right, const Vec3d& ahead,
                               double tau) {
  Camera eyes[2] = {look(left, left + ahead, 150, 166, 90),
                    look(right, right + ahead, 150, 166, 90)};
  eyes[0].cx = 93, eyes[1].cx = 57;
  eyes[0].cy = eyes[1].cy = 71;
  return stereo_input(eyes[0], eyes[1], tau);
}

// From outside and inside a cloud around the origin; eyes that are 65 mm apart, and 2 m; eyes
// of different sizes and fields of view.
inline std::vector<FrameInput> varied_pairs() {
  std::vector<FrameInput> all;
  for (const double tau : {0.0, 3.0, 12.0})
    all.push_back(headset_pair({3, -6, -24}, {3.065, -6, -24}, {-0.1, 0.2, 1}, tau));
  all.push_back(headset_pair({0, 1, 1}, {2, 1, 1}, {0.5, 0.1, 1}, 6));
  all.push_back(stereo_input(look({-12, 3, -9}, {0, 0, 0}, 161, 90),
                             look({-11.9, 3, -9}, {0, 0, 0}, 70, 131, 100), 8));
  return all;
}

}  // namespace voyager::test
