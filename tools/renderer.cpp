#include "tools/renderer.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/error.h"
#include "tools/backend_name.h"
#include "tools/console.h"
#include "tools/supersample.h"

namespace voyager::tools {
namespace {

// An error ends the command, and is printed there.
void write_log(void* user, VoyLogLevel level, const char* message) {
  RendererLog& log = *static_cast<RendererLog*>(user);
  if (level == VOY_LOG_LEVEL_INFO) return detail(message);
  if (level != VOY_LOG_LEVEL_WARNING) return;
  if (log.waits)
    log.warnings.push_back(without_call(message));
  else
    warn(without_call(message));
}

// The budget holds where the scene is drawn: in the host's memory, or in CUDA's own.
voy::Device create_device(const RenderChoices& choices, RendererLog& log) {
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.backend = choices.backend;
  desc.log = write_log;
  desc.logUser = &log;
  desc.logLevel = verbosity() == Verbosity::verbose ? VOY_LOG_LEVEL_INFO : VOY_LOG_LEVEL_WARNING;
  desc.deviceMemoryBudget = static_cast<uint64_t>(std::llround(choices.budget * 1e6));
  const bool on_host = choices.backend == VOY_BACKEND_CPU ||
                       choices.backend == VOY_BACKEND_REFERENCE ||
                       (choices.budget > 0 && choices.backend == VOY_BACKEND_AUTO &&
                        voyQueryBackend(VOY_BACKEND_CUDA) != VOY_SUCCESS);
  if (on_host) desc.hostMemoryBudget = desc.deviceMemoryBudget;
  return voy::Device::create(desc);
}

voy::Scene open_scene(const voy::Device& device, const std::string& path,
                      const RenderChoices& choices) {
  VoySceneDesc desc = VOY_SCENE_DESC_INIT;
  desc.path = path.c_str();
  VoySceneStreaming streaming = VOY_SCENE_STREAMING_INIT;
  streaming.startPosition = choices.start;
  if (choices.streamed) desc.next = &streaming;
  voy::Scene scene = device.open_scene(desc);
  if (choices.supersample > 1 && scene.info().nativePixelSource == VOY_NATIVE_PIXEL_SOURCE_UNKNOWN)
    throw Error(ErrorCode::refused_input,
                path +
                    ": found no native pixel, expected one, without which the truth of the "
                    "scene is not known: bake it anew");
  return scene;
}

voy::View create_view(const voy::Device& device, const voy::Scene& scene,
                      const RenderChoices& choices, uint32_t max_width, uint32_t max_height) {
  if (choices.time_budget > 0 && scene.info().nodeCount == 0)
    throw Error(ErrorCode::invalid_argument,
                "--time-budget: found a scene without a tree, which draws every leaf whatever tau "
                "is; expected one that was baked");
  const VoyScene handle = scene.get();
  VoyViewDesc desc = VOY_VIEW_DESC_INIT;
  desc.instanceCount = 1;
  desc.scenes = &handle;
  desc.eyeCount = choices.eyes;
  desc.maxWidth = max_width * choices.supersample;
  desc.maxHeight = max_height * choices.supersample;
  desc.lod = choices.lod;
  desc.tau = choices.tau;
  desc.antialias = choices.antialias;
  VoyExperiment experiment = choices.experiment;
  const bool temporal =
      experiment.search == VOY_SEARCH_AUTO || experiment.search == VOY_SEARCH_TEMPORAL;
  if (temporal && !choices.slack) experiment.search = VOY_SEARCH_TEMPORAL_VISIT;
  VoyTimeBudget budget = VOY_TIME_BUDGET_INIT;
  budget.milliseconds = choices.time_budget;
  if (choices.time_budget > 0) experiment.next = &budget;
  desc.next = &experiment;
  return device.create_view(desc);
}

}  // namespace

Renderer::Renderer(const std::string& scene, const RenderChoices& choices, uint32_t max_width,
                   uint32_t max_height)
    : choices_(choices),
      device_(create_device(choices, *log_)),
      scene_(open_scene(device_, scene, choices)),
      view_(create_view(device_, scene_, choices, max_width, max_height)),
      images_(choices.eyes) {}

VoySearch Renderer::search() const {
  VoyExperimentStats found = VOY_EXPERIMENT_STATS_INIT;
  VoyFrameStats stats = VOY_FRAME_STATS_INIT;
  stats.next = &found;
  voy::check(voyGetFrameStats(view_.get(), &stats));
  return found.search;
}

voy::Target Renderer::create_target(const Camera& camera, RenderedImage& image) const {
  const size_t pixels = size_t{camera.width} * camera.height;
  VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
  desc.width = camera.width;
  desc.height = camera.height;
  if (choices_.floats || samples()) {
    image.rgba32f.resize(4 * pixels);
    desc.colorFormat = VOY_COLOR_FORMAT_RGBA32F;
    desc.color = image.rgba32f.data();
  } else {
    image.rgba8.resize(4 * pixels);
    desc.color = image.rgba8.data();
  }
  if (choices_.depth) {
    image.depth.resize(pixels);
    desc.depth = image.depth.data();
  }
  return device_.create_target(desc);
}

// camera: of the picture.
void Renderer::average(const Camera& camera, RenderedImage& image) const {
  image.rgba32f = mean_of_samples(image.rgba32f, camera.width, camera.height, choices_.supersample);
  if (!choices_.floats) image.rgba8 = to_rgba8(image.rgba32f);
}

void Renderer::describe() const {
  log_->waits = false;
  for (const std::string& warning : log_->warnings) warn(warning);
  log_->warnings.clear();
  const VoyCapabilities found = device_.capabilities();
  const bool cuda = found.backend == VOY_BACKEND_CUDA;
  note(fmt::format("drawing with the {} backend: {}{}", backend_name(found.backend),
                   found.deviceName,
                   cuda ? "" : fmt::format(", {} threads", found.workerThreadCount)));
}

void Renderer::render(std::span<const Camera> cameras) {
  std::vector<voy::Target> targets;
  std::vector<VoyFrameEye> eyes(cameras.size(), VoyFrameEye VOY_FRAME_EYE_INIT);
  for (size_t i = 0; i < cameras.size(); ++i) {
    const uint32_t side = choices_.supersample;
    const Camera drawn = cameras[i].resized(cameras[i].width * side, cameras[i].height * side);
    targets.push_back(create_target(drawn, images_[i]));
    eyes[i].pose = drawn.pose;
    eyes[i].frustum = cameras[i].frustum();
    eyes[i].target = targets[i].get();
  }
  VoyFrame frame = VOY_FRAME_INIT;
  frame.eyeCount = static_cast<uint32_t>(eyes.size());
  frame.eyes = eyes.data();
  std::copy_n(choices_.background, 3, frame.background);
  VoyFrameStreaming streaming = VOY_FRAME_STREAMING_INIT;
  streaming.waitResident = choices_.wait_resident ? 1 : 0;
  streaming.allowFallback = choices_.keep_going ? 1 : 0;
  if (choices_.streamed) frame.next = &streaming;
  view_.render(frame);
  if (!samples()) return;
  for (size_t i = 0; i < cameras.size(); ++i) average(cameras[i], images_[i]);
}

}  // namespace voyager::tools
