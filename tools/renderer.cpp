#include "tools/renderer.h"

#include <algorithm>

namespace voyager::tools {
namespace {

voy::Device create_device(VoyBackend backend) {
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.backend = backend;
  return voy::Device::create(desc);
}

voy::View create_view(const voy::Device& device, VoyScene scene, const RenderChoices& choices,
                      uint32_t max_width, uint32_t max_height) {
  VoyViewDesc desc = VOY_VIEW_DESC_INIT;
  desc.instanceCount = 1;
  desc.scenes = &scene;
  desc.maxWidth = max_width;
  desc.maxHeight = max_height;
  desc.lod = choices.lod;
  desc.tau = choices.tau;
  desc.search = choices.search == VOY_SEARCH_TEMPORAL && !choices.slack ? VOY_SEARCH_TEMPORAL_VISIT
                                                                        : choices.search;
  desc.alphaFilter = choices.alpha_filter;
  desc.exponential = choices.exponential;
  desc.lutSize = choices.lut_size;
  desc.splatting = choices.splatting;
  return device.create_view(desc);
}

}  // namespace

Renderer::Renderer(const std::string& scene, const RenderChoices& choices, uint32_t max_width,
                   uint32_t max_height)
    : choices_(choices),
      device_(create_device(choices.backend)),
      scene_(device_.open_scene(scene)),
      view_(create_view(device_, scene_.get(), choices, max_width, max_height)) {}

bool Renderer::draws_cut() const {
  return choices_.lod == VOY_LOD_CUT && scene_.info().storage != VOY_SCENE_STORAGE_FLAT;
}

voy::Target Renderer::create_target(const Camera& camera) {
  const size_t pixels = size_t{camera.width} * camera.height;
  VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
  desc.width = camera.width;
  desc.height = camera.height;
  if (choices_.floats) {
    rgba32f_.resize(4 * pixels);
    desc.colorFormat = VOY_COLOR_FORMAT_RGBA32F;
    desc.color = rgba32f_.data();
  } else {
    rgba8_.resize(4 * pixels);
    desc.color = rgba8_.data();
  }
  if (choices_.depth) {
    depth_.resize(pixels);
    desc.depth = depth_.data();
  }
  return device_.create_target(desc);
}

void Renderer::render(const Camera& camera) {
  const voy::Target target = create_target(camera);
  VoyFrameEye eye = VOY_FRAME_EYE_INIT;
  eye.pose = camera.pose;
  eye.frustum = camera.frustum();
  eye.target = target.get();
  VoyFrame frame = VOY_FRAME_INIT;
  frame.eyeCount = 1;
  frame.eyes = &eye;
  std::copy_n(choices_.background, 3, frame.background);
  view_.render(frame);
}

}  // namespace voyager::tools
