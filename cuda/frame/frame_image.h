#pragma once
// An eye's image on the device, and its way to the host.
#include <optional>

#include "cuda/device/buffer.h"
#include "cuda/device/stream.h"
#include "cuda/splat/splat_launch.h"
#include "runtime/frame/backend.h"

namespace voyager::cuda {

class FrameImage {
 public:
  // Whether there is room for the eye's image; another API's needs none.
  bool fits(const FrameEye& eye) const;
  // Makes it. Nothing on the device uses the buffers. Throws Error.
  void fit(const FrameEye& eye);
  // The target of a frame, of the image's size and format. There is room.
  RasterTarget target(const FrameEye& eye, const Vec3f& background);
  // Launches the copy of what the stream has drawn, where the image has memory; else false.
  bool fetch(const Image& image, cudaStream_t stream) const;
  // The last stage: into the image's memory, where it has any. What fetch() launched has ended.
  void resolve(const Image& image, Workers& workers, FrameStats& stats) const;
  // Of the largest so far; 0 where there was none.
  uint64_t pixels() const { return pixels_; }
  // Whether one had depth.
  bool depth() const { return depth_.drawn.size() != 0; }

 private:
  struct Plane {
    Buffer<unsigned char> drawn;
    // On its way to the host: a copy into pageable memory would keep the host's thread busy until
    // the device has drawn the image.
    std::optional<PinnedMemory> fetched;

    bool fits(size_t bytes, size_t to_host) const;
    void fit(size_t bytes, size_t to_host);
    void fetch(size_t to_host, cudaStream_t stream) const;
    // Rows of so many bytes.
    void put(void* into, size_t pitch, size_t row, uint32_t rows, Workers& workers) const;
  };

  uint64_t pixels_ = 0;
  Plane color_, depth_;
};

}  // namespace voyager::cuda
