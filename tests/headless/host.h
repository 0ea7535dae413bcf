#pragma once
// One of everything: a device, the small scene, a target and a view.
#include <cmath>
#include <vector>

#include "library.h"
#include "scene_bytes.h"

inline VoyDeviceDesc device_for(VoyBackend backend) {
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.backend = backend;
  return desc;
}

struct Host {
  static constexpr uint32_t kWidth = 96, kHeight = 64;

  explicit Host(const Library& library, VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT,
                int gaussians = 300)
      : voy(library) {
    EXPECT_EQ(voy.CreateDevice(&desc, &device), VOY_SUCCESS) << voy.message();
    bytes.bytes = ply_bytes(gaussians);
    const VoyByteSource source = bytes.source();
    VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
    scene_desc.source = &source;
    EXPECT_EQ(voy.OpenScene(device, &scene_desc, &scene), VOY_SUCCESS) << voy.message();
    const VoyTargetDesc wanted = target_desc();
    EXPECT_EQ(voy.CreateTarget(device, &wanted, &target), VOY_SUCCESS) << voy.message();
    const VoyViewDesc view_wanted = view_desc();
    EXPECT_EQ(voy.CreateView(device, &view_wanted, &view), VOY_SUCCESS) << voy.message();
  }
  ~Host() { EXPECT_EQ(voy.DestroyDevice(device), VOY_SUCCESS) << voy.message(); }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  VoyTargetDesc target_desc() {
    VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
    desc.colorFormat = VOY_COLOR_FORMAT_RGBA32F;
    desc.width = kWidth;
    desc.height = kHeight;
    desc.color = pixels.data();
    desc.depth = depth.data();
    return desc;
  }
  VoyViewDesc view_desc() {
    VoyViewDesc desc = VOY_VIEW_DESC_INIT;
    desc.instanceCount = 1;
    desc.scenes = &scene;
    desc.maxWidth = kWidth;
    desc.maxHeight = kHeight;
    return desc;
  }
  // Looks along -z at the scene from x, 12 m before it, turned by yaw.
  VoyFrameEye eye(double x = 0, double yaw = 0) {
    VoyFrameEye eye = VOY_FRAME_EYE_INIT;
    eye.pose.position[0] = x;
    eye.pose.position[2] = 12;
    eye.pose.orientation[1] = std::sin(yaw / 2);
    eye.pose.orientation[3] = std::cos(yaw / 2);
    eye.frustum = {-0.6, 0.6, 0.4, -0.4};
    eye.target = target;
    return eye;
  }
  static VoyFrame frame(const VoyFrameEye& eye) {
    VoyFrame frame = VOY_FRAME_INIT;
    frame.eyeCount = 1;
    frame.eyes = &eye;
    return frame;
  }
  VoyResult render(const VoyFrameEye& eye) {
    const VoyFrame wanted = frame(eye);
    return voy.RenderFrame(view, &wanted);
  }
  VoyResult render(double x = 0, double yaw = 0) { return render(eye(x, yaw)); }

  const Library& voy;
  BytesHost bytes;
  std::vector<float> pixels = std::vector<float>(size_t{kWidth} * kHeight * 4, -1.0f);
  std::vector<float> depth = std::vector<float>(size_t{kWidth} * kHeight, -1.0f);
  VoyDevice device = nullptr;
  VoyScene scene = nullptr;
  VoyTarget target = nullptr;
  VoyView view = nullptr;
};
