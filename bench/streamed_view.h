#pragma once
// A streamed scene and a view of it that draws into host memory, through the C ABI.
#include <cmath>
#include <vector>

#include "tools/cameras.h"
#include "voyager/voyager.hpp"

namespace voyager::bench {

// The best device, with a budget for scene data in its memory.
inline voy::Device streaming_device(double megabytes) {
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.deviceMemoryBudget = static_cast<uint64_t>(megabytes * 1e6);
  return voy::Device::create(desc);
}

// Turned about the viewer's own upward axis.
inline tools::Camera turned(tools::Camera camera, double radians) {
  double* q = camera.pose.orientation;
  const double s = std::sin(radians / 2), c = std::cos(radians / 2);
  const double x = q[0] * c - q[2] * s, y = q[1] * c + q[3] * s, z = q[2] * c + q[0] * s,
               w = q[3] * c - q[1] * s;
  q[0] = x, q[1] = y, q[2] = z, q[3] = w;
  return camera;
}

class StreamedView {
 public:
  // start: where to read first; none: at the top of the tree. readers: as
  // VoySceneStreaming::readerThreadCount.
  StreamedView(const voy::Device& device, const char* path, double megabytes, const double* start,
               unsigned width, unsigned height, double tau, uint32_t readers = 0)
      : scene(open(device, path, megabytes, start, readers)),
        view(create(device, width, height, tau)),
        pixels_(size_t{4} * width * height) {
    VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
    desc.width = width;
    desc.height = height;
    desc.color = pixels_.data();
    target_ = device.create_target(desc);
  }

  void render(const tools::Camera& camera) {
    VoyFrameEye eye = VOY_FRAME_EYE_INIT;
    eye.pose = camera.pose;
    eye.frustum = camera.frustum();
    eye.target = target_.get();
    VoyFrame frame = VOY_FRAME_INIT;
    frame.eyeCount = 1;
    frame.eyes = &eye;
    view.render(frame);
  }

  // RGBA8, row by row: of the last frame.
  const std::vector<uint8_t>& pixels() const { return pixels_; }

  const voy::Scene scene;
  voy::View view;

  static voy::Scene open(const voy::Device& device, const char* path, double megabytes,
                         const double* start, uint32_t readers) {
    VoySceneStreaming streaming = VOY_SCENE_STREAMING_INIT;
    streaming.memoryBudget = static_cast<uint64_t>(megabytes * 1e6);
    streaming.startPosition = start;
    streaming.readerThreadCount = readers;
    VoySceneDesc desc = VOY_SCENE_DESC_INIT;
    desc.next = &streaming;
    desc.path = path;
    return device.open_scene(desc);
  }

 private:
  voy::View create(const voy::Device& device, unsigned width, unsigned height, double tau) const {
    const VoyScene handle = scene.get();
    VoyViewDesc desc = VOY_VIEW_DESC_INIT;
    desc.instanceCount = 1;
    desc.scenes = &handle;
    desc.maxWidth = width;
    desc.maxHeight = height;
    desc.tau = tau;
    return device.create_view(desc);
  }

  std::vector<uint8_t> pixels_;
  voy::Target target_;
};

}  // namespace voyager::bench
