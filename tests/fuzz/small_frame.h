#pragma once
// Frames of a few pixels of a scene of which nothing is known but that it was opened.
#include <array>
#include <cmath>
#include <vector>

#include "runtime/frame/view.h"

namespace voyager::fuzz {

inline constexpr uint32_t kWidth = 20, kHeight = 12;

struct Picture {
  std::vector<float> rgba = std::vector<float>(size_t{4} * kWidth * kHeight, NAN);
  std::vector<float> depth = std::vector<float>(size_t{kWidth} * kHeight, NAN);
  std::vector<uint32_t> cut;
};

// Along z, from `back` times the scene's size before its middle.
inline FrameInput frame_of(const Scene& scene, double back, double tau) {
  FrameInput input;
  Camera& camera = input.eyes[0].camera;
  const Vec3f &low = scene.bounds_min, &high = scene.bounds_max;
  double size = 1;
  for (int axis = 0; axis < 3; ++axis) {
    camera.eye[axis] = scene.origin[axis] + 0.5 * (double{low[axis]} + high[axis]);
    size = std::fmax(size, double{high[axis]} - low[axis]);
  }
  camera.eye[2] -= back * size;
  camera.world_to_view = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  camera.width = kWidth;
  camera.height = kHeight;
  camera.fx = camera.fy = kWidth;
  camera.cx = 0.5 * kWidth;
  camera.cy = 0.5 * kHeight;
  input.tau = tau;
  input.eyes[0].depth_wanted = true;
  return input;
}

inline Picture draw(View& view, const FrameInput& input) {
  Picture picture;
  Image image;
  image.format = ColorFormat::rgba32f;
  image.width = kWidth;
  image.height = kHeight;
  image.color = picture.rgba.data();
  image.color_pitch = size_t{16} * kWidth;
  image.depth = picture.depth.data();
  image.depth_pitch = size_t{4} * kWidth;
  view.render(input, image);
  if (view.draws_cut(0)) picture.cut.assign(view.cut().begin(), view.cut().end());
  for (const float value : picture.rgba)
    if (std::isnan(value)) std::abort();
  for (const float value : picture.depth)
    if (std::isnan(value)) std::abort();
  return picture;
}

}  // namespace voyager::fuzz
