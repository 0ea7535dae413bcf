#pragma once
// An eye's image on the device, and its way to the host.
#include "cuda/device/buffer.h"
#include "cuda/splat/splat_launch.h"
#include "runtime/frame/backend.h"

namespace voyager::cuda {

class FrameImage {
 public:
  // The target of a frame, of the image's size and format. May allocate.
  RasterTarget target(const FrameEye& eye, const Vec3f& background);
  // The last stage: into the image's memory, where it has any. The stream's work is done.
  void resolve(const Image& image, FrameStats& stats) const;
  // Of the largest so far; 0 where there was none.
  uint64_t pixels() const { return pixels_; }
  // Whether one had depth.
  bool depth() const { return depth_.size() != 0; }

 private:
  uint64_t pixels_ = 0;
  Buffer<unsigned char> color_;
  Buffer<float> depth_;
};

}  // namespace voyager::cuda
