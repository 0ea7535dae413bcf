#include "cuda/frame/frame_image.h"

#include <algorithm>
#include <cstring>

#include "runtime/base/clock.h"

namespace voyager::cuda {
namespace {

bool has_depth(const FrameEye& eye) {
  return eye.depth_wanted || eye.image.depth != nullptr;
}

size_t pixels_of(const Image& image) {
  return size_t{image.width} * image.height;
}
size_t color_bytes(const Image& image) {
  return pixels_of(image) * pixel_bytes(image.format);
}
size_t depth_bytes(const FrameEye& eye) {
  return has_depth(eye) ? pixels_of(eye.image) * sizeof(float) : 0;
}
// Of these, what goes to the host.
size_t fetched_color(const Image& image) {
  return image.color != nullptr ? color_bytes(image) : 0;
}
size_t fetched_depth(const Image& image) {
  return image.depth != nullptr ? pixels_of(image) * sizeof(float) : 0;
}

}  // namespace

bool FrameImage::Plane::fits(size_t bytes, size_t to_host) const {
  return drawn.size() >= bytes && (fetched ? fetched->bytes() : 0) >= to_host;
}

// The old ones go first: nothing in them outlives a frame.
void FrameImage::Plane::fit(size_t bytes, size_t to_host) {
  if (drawn.size() < bytes) drawn = {}, drawn = Buffer<unsigned char>(bytes);
  if (fits(bytes, to_host)) return;
  fetched.reset();
  fetched.emplace(to_host);
}

void FrameImage::Plane::fetch(size_t to_host, cudaStream_t stream) const {
  if (to_host == 0) return;
  check(cudaMemcpyAsync(fetched->data(), drawn.data(), to_host, cudaMemcpyDeviceToHost, stream),
        "an image");
}

// By several threads: one takes longer for an image than the device for its way to the host.
void FrameImage::Plane::put(void* into, size_t pitch, size_t row, uint32_t rows,
                            Workers& workers) const {
  constexpr size_t kBlock = size_t{1} << 20;  // bytes
  auto* const to = static_cast<unsigned char*>(into);
  workers.for_blocks(rows, std::max<size_t>(kBlock / row, 1), [&](size_t begin, size_t end) {
    if (pitch == row) {
      std::memcpy(to + begin * row, fetched->data() + begin * row, (end - begin) * row);
      return;
    }
    for (size_t y = begin; y < end; ++y)
      std::memcpy(to + y * pitch, fetched->data() + y * row, row);
  });
}

bool FrameImage::fits(const FrameEye& eye) const {
  return eye.image.external.ring != nullptr ||
         (color_.fits(color_bytes(eye.image), fetched_color(eye.image)) &&
          depth_.fits(depth_bytes(eye), fetched_depth(eye.image)));
}

void FrameImage::fit(const FrameEye& eye) {
  if (fits(eye)) return;
  color_.fit(color_bytes(eye.image), fetched_color(eye.image));
  depth_.fit(depth_bytes(eye), fetched_depth(eye.image));
}

RasterTarget FrameImage::target(const FrameEye& eye, const Vec3f& background) {
  const Image& image = eye.image;
  pixels_ = std::max<uint64_t>(pixels_, pixels_of(image));
  RasterTarget target{};
  target.format = image.format;
  target.color = color_.drawn.data();
  target.depth = has_depth(eye) ? reinterpret_cast<float*>(depth_.drawn.data()) : nullptr;
  target.width = image.width;
  target.height = image.height;
  target.background = background;
  return target;
}

bool FrameImage::fetch(const Image& image, cudaStream_t stream) const {
  color_.fetch(fetched_color(image), stream);
  depth_.fetch(fetched_depth(image), stream);
  return fetched_color(image) + fetched_depth(image) != 0;
}

void FrameImage::resolve(const Image& image, Workers& workers, FrameStats& stats) const {
  const Stopwatch stage;
  if (fetched_color(image) != 0)
    color_.put(image.color, image.color_pitch, image.width * pixel_bytes(image.format),
               image.height, workers);
  if (fetched_depth(image) != 0)
    depth_.put(image.depth, image.depth_pitch, image.width * sizeof(float), image.height, workers);
  const double milliseconds = stage.milliseconds();
  stats.milliseconds[kResolve] += milliseconds;
  stats.total_milliseconds += milliseconds;
}

}  // namespace voyager::cuda
