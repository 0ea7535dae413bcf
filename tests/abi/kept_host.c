/* A host in C99, compiled against the headers that header_MAJOR.MINOR keeps. */
#include "kept_host.h"

#include <string.h>

#include <voyager/voyager_vulkan.h>

enum { kSide = 16 };

#define VOY_TEST_EXPECT(condition)       \
  do {                                   \
    if (!(condition)) return #condition; \
  } while (0)

static int64_t logged;

static void VOY_CALL count_message(void* user, VoyLogLevel level, const char* message) {
  logged += user == &logged && level <= VOY_LOG_LEVEL_INFO && message[0] != '\0';
}

static const char* check_frame(VoyView view, const uint8_t* color, const float* depth) {
  VoyFrameStats stats = VOY_FRAME_STATS_INIT;
  int opaque = 0, seen = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    opaque += color[4 * i + 3] > 128;
    seen += depth[i] > 1 && depth[i] < 100;
  }
  if (opaque == 0) return "nothing was drawn";
  if (seen == 0) return "no depth was drawn";
  if (voyGetFrameStats(view, &stats) < 0) return voyGetLastErrorMessage();
  if (stats.splats == 0 || stats.tau != 5 || stats.millisecondsTotal <= 0 || stats.stageCount == 0)
    return "the statistics are not of this frame";
  return NULL;
}

/* What needs no device. */
static const char* ask_the_library(void) {
  VoyDeviceInfo infos[8];
  uint32_t count = 0;
  for (int i = 0; i < 8; ++i) infos[i] = (VoyDeviceInfo)VOY_DEVICE_INFO_INIT;
  VOY_TEST_EXPECT(voyGetVersion() >= VOY_API_VERSION);
  VOY_TEST_EXPECT(strcmp(voyResultName(VOY_ERROR_SCENE_CLOSED), "VOY_ERROR_SCENE_CLOSED") == 0);
  VOY_TEST_EXPECT(strcmp(voyStageName(VOY_STAGE_SORT), "sort") == 0);
  VOY_TEST_EXPECT(voyQueryBackend(VOY_BACKEND_CPU) == VOY_SUCCESS);
  VOY_TEST_EXPECT(voyEnumerateDevices(8, infos, &count) >= 0 && count >= 2);
  VOY_TEST_EXPECT(infos[0].type == VOY_STRUCTURE_TYPE_DEVICE_INFO);
  return NULL;
}

static const char* convert(void) {
  const double world[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 3, 4, 1};
  const double projection[16] = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1, -1, 0, 0, -1, 0};
  VoyFrustum frustum = VOY_FRUSTUM_INIT;
  VoyPose pose = VOY_POSE_INIT;
  VOY_TEST_EXPECT(voyFrustumFromIntrinsics(8, 8, 8, 8, 16, 16, &frustum) == VOY_SUCCESS);
  VOY_TEST_EXPECT(frustum.left == -1 && frustum.right == 1 && frustum.up == 1);
  VOY_TEST_EXPECT(voyFrustumFromProjection(projection, VOY_CLIP_Y_UP, &frustum) == VOY_SUCCESS);
  VOY_TEST_EXPECT(frustum.left == -0.5 && frustum.down == -0.5);
  VOY_TEST_EXPECT(voyPoseFromWorldMatrix(world, VOY_HAND_RIGHT, &pose) == VOY_SUCCESS);
  VOY_TEST_EXPECT(pose.position[0] == 2 && pose.position[2] == 4 && pose.orientation[3] == 1);
  VOY_TEST_EXPECT(voyPoseFromViewMatrix(world, VOY_HAND_RIGHT, &pose) == VOY_SUCCESS);
  VOY_TEST_EXPECT(pose.position[0] == -2);
  return NULL;
}

/* Of a flat scene on a CPU. */
static const char* ask(VoyScene scene, VoyView view) {
  VoyTimeBudget budget = VOY_TIME_BUDGET_INIT;
  VoyStreamingStats streaming = VOY_STREAMING_STATS_INIT;
  uint32_t count = 0;
  budget.milliseconds = 10;
  VOY_TEST_EXPECT(voyGetSceneNotes(scene, 0, NULL, &count) == VOY_SUCCESS && count > 0);
  VOY_TEST_EXPECT(voySetSceneMemoryBudget(scene, 1) == VOY_ERROR_UNSUPPORTED);
  VOY_TEST_EXPECT(voyGetStreamingStats(scene, &streaming) == VOY_ERROR_UNSUPPORTED);
  VOY_TEST_EXPECT(voyGetViewCut(view, 0, 0, NULL, &count) == VOY_ERROR_UNSUPPORTED);
  VOY_TEST_EXPECT(voyGetViewOmissions(view, 0, NULL, &count) == VOY_SUCCESS && count > 0);
  VOY_TEST_EXPECT(voySetViewTimeBudget(view, &budget) == VOY_SUCCESS);
  VOY_TEST_EXPECT(voySetViewTau(view, 5) == VOY_SUCCESS);
  return NULL;
}

/* A host without Vulkan is refused, whatever it calls. */
static const char* ask_for_vulkan(VoyDevice device, VoyTarget target) {
  VoyVulkanUse use = VOY_VULKAN_USE_INIT;
  VoyVulkanCopy copy = VOY_VULKAN_COPY_INIT;
  VoyVulkanDepthLimit limit = VOY_VULKAN_DEPTH_LIMIT_INIT;
  VoyVulkanCompositeDesc desc = VOY_VULKAN_COMPOSITE_DESC_INIT;
  VoyVulkanCompositeDraw drawn = VOY_VULKAN_COMPOSITE_DRAW_INIT;
  VoyVulkanComposite composite = NULL;
  uint32_t count = 0;
  VOY_TEST_EXPECT(voyGetVulkanImages(target, 0, NULL, &count) < 0);
  VOY_TEST_EXPECT(voyRecordVulkanRelease(target, &use) < 0);
  VOY_TEST_EXPECT(voyRecordVulkanAcquire(target, &use) < 0);
  VOY_TEST_EXPECT(voyRecordVulkanCopy(target, &copy) < 0);
  VOY_TEST_EXPECT(voyRecordVulkanDepthLimit(target, &limit) < 0);
  VOY_TEST_EXPECT(voyCreateVulkanComposite(device, &desc, &composite) < 0);
  VOY_TEST_EXPECT(voyRecordVulkanComposite(composite, &drawn) == VOY_ERROR_INVALID_HANDLE);
  VOY_TEST_EXPECT(voyDestroyVulkanComposite(composite) == VOY_SUCCESS);
  return NULL;
}

static const char* draw(VoyDevice device, VoyScene scene) {
  static uint8_t color[kSide * kSide * 4];
  static float depth[kSide * kSide];
  VoyViewDesc view_desc = VOY_VIEW_DESC_INIT;
  VoyTargetDesc target_desc = VOY_TARGET_DESC_INIT;
  VoyFrameEye eye = VOY_FRAME_EYE_INIT;
  VoyInstancePose instance = VOY_INSTANCE_POSE_INIT;
  VoyInstance listed = VOY_INSTANCE_INIT;
  VoyFrame frame = VOY_FRAME_INIT;
  VoyView view = NULL;
  const char* problem;
  view_desc.instanceCount = 1;
  view_desc.scenes = &scene;
  view_desc.maxWidth = view_desc.maxHeight = kSide;
  view_desc.tau = 5;
  if (voyCreateView(device, &view_desc, &view) < 0) return voyGetLastErrorMessage();
  target_desc.width = target_desc.height = kSide;
  target_desc.color = color;
  target_desc.depth = depth;
  if (voyCreateTarget(device, &target_desc, &eye.target) < 0) return voyGetLastErrorMessage();
  if (voyFrustumFromAngles(-0.7, 0.7, 0.7, -0.7, &eye.frustum) < 0) return voyGetLastErrorMessage();
  eye.pose.position[2] = 12;
  frame.eyeCount = 1;
  frame.eyes = &eye;
  frame.instances = &instance;
  frame.instanceCount = 1;
  if (voyRenderFrame(view, &frame) < 0) return voyGetLastErrorMessage();
  problem = check_frame(view, color, depth);
  if (problem == NULL) problem = ask(scene, view);
  if (problem == NULL) problem = ask_for_vulkan(device, eye.target);
  if (problem != NULL) return problem;
  listed.scene = scene;
  listed.opacity = 0;
  frame.instances = NULL;
  frame.instanceCount = 0;
  if (voySetViewInstances(view, 1, &listed) < 0) return voyGetLastErrorMessage();
  if (voyRenderFrame(view, &frame) < 0) return voyGetLastErrorMessage();
  for (int i = 0; i < kSide * kSide; ++i)
    if (color[4 * i + 3] != 0) return "an instance of opacity 0 was drawn";
  VOY_TEST_EXPECT(voyDestroyView(view) == VOY_SUCCESS);
  VOY_TEST_EXPECT(voyDestroyTarget(eye.target) == VOY_SUCCESS);
  return NULL;
}

static const char* open_and_draw(VoyDevice device, const char* path) {
  VoySceneDesc desc = VOY_SCENE_DESC_INIT;
  VoySceneInfo info = VOY_SCENE_INFO_INIT;
  VoyCapabilities capabilities = VOY_CAPABILITIES_INIT;
  VoyScene scene = NULL;
  const char* problem;
  if (voyGetCapabilities(device, &capabilities) < 0) return voyGetLastErrorMessage();
  if (capabilities.workerThreadCount != 2 || capabilities.maxEyes < 2) return "the capabilities";
  desc.path = path;
  if (voyOpenScene(device, &desc, &scene) < 0) return voyGetLastErrorMessage();
  if (voyGetSceneInfo(scene, &info) < 0) return voyGetLastErrorMessage();
  if (info.gaussianCount == 0 || info.boundsMax[0] <= info.boundsMin[0]) return "the scene's facts";
  problem = draw(device, scene);
  if (problem == NULL && voyCloseScene(scene) < 0) problem = voyGetLastErrorMessage();
  return problem;
}

const char* run_kept_host(const char* scene) {
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  VoyVulkanPhysicalDevice nothing = VOY_VULKAN_PHYSICAL_DEVICE_INIT;
  VoyVulkanRequirements needs = VOY_VULKAN_REQUIREMENTS_INIT;
  VoyDevice device = NULL;
  const char* problem;
  desc.backend = VOY_BACKEND_CPU;
  desc.workerThreadCount = 2;
  desc.logLevel = VOY_LOG_LEVEL_INFO;
  desc.log = count_message;
  desc.logUser = &logged;
  if (voyCreateDevice(&desc, &device) < 0) return voyGetLastErrorMessage();
  problem = ask_the_library();
  if (problem == NULL) problem = convert();
  if (problem == NULL) problem = open_and_draw(device, scene);
  if (problem == NULL && logged == 0) problem = "no message was logged";
  if (problem == NULL && voyGetVulkanRequirements(&nothing, &needs) != VOY_ERROR_INVALID_ARGUMENT)
    problem = "a Vulkan host without vkGetInstanceProcAddr was not refused";
  if (voyDestroyDevice(device) < 0) return voyGetLastErrorMessage();
  return problem;
}
