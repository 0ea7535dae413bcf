// A host in C++17 without exceptions and run-time types, as engines are built.
#include "no_exceptions.h"

#include <type_traits>
#include <voyager/voyager.hpp>

static_assert(std::is_same_v<decltype(voy::View().set_tau(1)), VoyResult>);

namespace {

const char* draw(const voy::Device& device, const voy::Scene& scene) {
  const VoyScene scenes[] = {scene.get()};
  VoyViewDesc view_desc = VOY_VIEW_DESC_INIT;
  view_desc.instanceCount = 1;
  view_desc.scenes = scenes;
  view_desc.maxWidth = view_desc.maxHeight = 8;
  auto view = device.create_view(view_desc);
  if (!view) return "no view";
  uint8_t pixels[8 * 8 * 4];
  VoyTargetDesc target_desc = VOY_TARGET_DESC_INIT;
  target_desc.width = target_desc.height = 8;
  target_desc.color = pixels;
  const auto target = device.create_target(target_desc);
  if (!target) return "no target";
  VoyFrameEye eye = VOY_FRAME_EYE_INIT;
  eye.frustum = {-1, 1, 1, -1};
  eye.target = target.value.get();
  VoyFrame frame = VOY_FRAME_INIT;
  frame.eyeCount = 1;
  frame.eyes = &eye;
  if (view.value.stats()) return "statistics before the first frame";
  if (view.value.render(frame) != VOY_SUCCESS) return voyGetLastErrorMessage();
  const auto stats = view.value.stats();
  if (!stats || stats.value.frameIndex != 0) return "no statistics";
  if (view.value.set_tau(-1) != VOY_ERROR_INVALID_ARGUMENT) return "a negative tau";
  return nullptr;
}

}  // namespace

const char* use_without_exceptions(const char* path) {
  const auto devices = voy::devices();
  if (!devices || devices.value.empty()) return "no list of devices";
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.backend = VOY_BACKEND_CPU;
  const auto device = voy::Device::create(desc);
  if (!device) return voyGetLastErrorMessage();
  const auto missing = device.value.open_scene("no such file");
  if (missing.result != VOY_ERROR_FILE_NOT_FOUND || missing.value) return "a scene from nothing";
  const auto scene = device.value.open_scene(path);
  if (!scene) return voyGetLastErrorMessage();
  const auto info = scene.value.info();
  if (!info || info.value.gaussianCount == 0) return "no facts";
  if (!scene.value.notes()) return "no notes";
  return draw(device.value, scene.value);
}
