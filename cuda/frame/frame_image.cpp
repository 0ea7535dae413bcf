#include "cuda/frame/frame_image.h"

#include <algorithm>

#include "runtime/base/clock.h"

namespace voyager::cuda {

RasterTarget FrameImage::target(const FrameEye& eye, const Vec3f& background) {
  const Image& image = eye.image;
  const size_t pixels = size_t{image.width} * image.height;
  pixels_ = std::max<uint64_t>(pixels_, pixels);
  const size_t bytes = pixels * pixel_bytes(image.format);
  if (color_.size() < bytes) color_ = {}, color_ = Buffer<unsigned char>(bytes);
  const bool depth = eye.depth_wanted || image.depth != nullptr;
  if (depth && depth_.size() < pixels) depth_ = {}, depth_ = Buffer<float>(pixels);
  RasterTarget target{};
  target.format = image.format;
  target.color = color_.data();
  target.depth = depth ? depth_.data() : nullptr;
  target.width = image.width;
  target.height = image.height;
  target.background = background;
  return target;
}

void FrameImage::resolve(const Image& image, FrameStats& stats) const {
  const Stopwatch stage;
  const auto copy = [&](void* into, size_t pitch, const void* from, size_t row) {
    check(cudaMemcpy2D(into, pitch, from, row, row, image.height, cudaMemcpyDeviceToHost),
          "an image");
  };
  if (image.color != nullptr)
    copy(image.color, image.color_pitch, color_.data(), image.width * pixel_bytes(image.format));
  if (image.depth != nullptr)
    copy(image.depth, image.depth_pitch, depth_.data(), image.width * sizeof(float));
  const double milliseconds = stage.milliseconds();
  stats.milliseconds[kResolve] += milliseconds;
  stats.total_milliseconds += milliseconds;
}

}  // namespace voyager::cuda
