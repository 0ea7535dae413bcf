// What a host must not ask, and what it is told.
#include <set>

#include "frames.h"

namespace refusal_test {
namespace {

void expect_refused(VoyResult found, VoyResult expected, const char* part) {
  EXPECT_EQ(found, expected);
  EXPECT_NE(std::string(voyGetLastErrorMessage()).find(part), std::string::npos)
      << voyGetLastErrorMessage() << " should name " << part;
}

// What a host names before it has a physical device covers what the device is then found to have.
TEST_F(Interop, RequirementsBeforeAnInstanceNameWhatADeviceMayNeed) {
  VoyVulkanRequirements needs = VOY_VULKAN_REQUIREMENTS_INIT;
  ASSERT_EQ(voyGetVulkanRequirements(nullptr, &needs), VOY_SUCCESS);
  EXPECT_EQ(needs.vulkanVersion, VK_API_VERSION_1_1);
  EXPECT_EQ(needs.instanceExtensionCount, 0u);
  EXPECT_EQ(needs.timelineSemaphore, VK_TRUE);
  const std::set<std::string> named(needs.deviceExtensions,
                                    needs.deviceExtensions + needs.deviceExtensionCount);
  EXPECT_EQ(named.count(VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME), 1u);
  for (const char* extension : host->extensions) EXPECT_EQ(named.count(extension), 1u) << extension;
  VoyVulkanPhysicalDevice none = VOY_VULKAN_PHYSICAL_DEVICE_INIT;
  expect_refused(voyGetVulkanRequirements(&none, &needs), VOY_ERROR_INVALID_ARGUMENT,
                 "VoyVulkanPhysicalDevice.getInstanceProcAddr: found NULL");
}

TEST_F(Interop, ADeviceIsRefusedByWhatIsWrong) {
  VoyVulkanDeviceDesc vulkan = host->desc();
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.next = &vulkan;
  VoyDevice made = nullptr;
  const auto refused = [&](VoyResult result, const char* part) {
    expect_refused(voyCreateDevice(&desc, &made), result, part);
    EXPECT_EQ(made, nullptr);
    vulkan = host->desc();
  };
  vulkan.device = VK_NULL_HANDLE;
  refused(VOY_ERROR_INVALID_ARGUMENT, "VoyVulkanDeviceDesc.device: found NULL");
  vulkan.vulkanVersion = VK_API_VERSION_1_0;
  refused(VOY_ERROR_UNSUPPORTED, "1.1");
  vulkan.sync = static_cast<VoyVulkanSync>(9);
  refused(VOY_ERROR_INVALID_ARGUMENT, "sync");
  vulkan.timelineSemaphore = VK_FALSE;
  vulkan.sync = VOY_VULKAN_SYNC_TIMELINE;
  refused(VOY_ERROR_UNSUPPORTED, "timelineSemaphore");
  vulkan.sharing = VOY_VULKAN_SHARING_HOST;
  vulkan.sync = VOY_VULKAN_SYNC_BINARY;
  refused(VOY_ERROR_UNSUPPORTED, "HOST sharing");
  desc.backend = VOY_BACKEND_CPU;
  vulkan.sharing = VOY_VULKAN_SHARING_DEVICE;
  refused(VOY_ERROR_UNSUPPORTED, "does not draw on this device");
  uint8_t uuid[16] = {0x9a};
  desc.deviceUuid = uuid;
  refused(VOY_ERROR_INVALID_ARGUMENT, "deviceUuid");
}

TEST_F(Interop, CapabilitiesSayWhatWasChosen) {
  FOR_EACH_MODE({
    EXPECT_EQ(found.sharing, sharing);
    EXPECT_EQ(found.sync, sync);
    EXPECT_EQ(capabilities.targetKinds >> VOY_TARGET_KIND_VULKAN & 1, 1u);
    EXPECT_TRUE(sharing == VOY_VULKAN_SHARING_HOST || !found.hostMemoryImport);
  });
  // By themselves: CUDA's images where CUDA draws on the Vulkan device, else the host's.
  ASSERT_TRUE(create());
  const bool cuda = capabilities.backend == VOY_BACKEND_CUDA;
  EXPECT_EQ(found.sharing, cuda ? VOY_VULKAN_SHARING_DEVICE : VOY_VULKAN_SHARING_HOST);
  EXPECT_EQ(cuda, found.why[0] == '\0') << found.why;
}

TEST_F(Interop, WithoutVulkanThereIsNoVulkanTarget) {
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  ASSERT_EQ(voyCreateDevice(&desc, &device), VOY_SUCCESS);
  VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
  const VoyTargetDesc wanted = target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images);
  VoyTarget target = nullptr;
  expect_refused(voyCreateTarget(device, &wanted, &target), VOY_ERROR_UNSUPPORTED,
                 "VoyVulkanDeviceDesc");
  VoyCapabilities all = VOY_CAPABILITIES_INIT;
  all.next = &found;
  expect_refused(voyGetCapabilities(device, &all), VOY_ERROR_UNSUPPORTED, "VoyVulkanDeviceDesc");
}

TEST_F(Interop, ATargetIsRefusedByWhatIsWrong) {
  ASSERT_TRUE(create());
  VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
  VoyTargetDesc desc = target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images);
  VoyTarget target = nullptr;
  const auto refused = [&](VoyResult result, const char* part) {
    expect_refused(voyCreateTarget(device, &desc, &target), result, part);
    EXPECT_EQ(target, nullptr);
    images = VOY_VULKAN_TARGET_DESC_INIT;
    desc = target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images);
  };
  desc.next = nullptr;
  refused(VOY_ERROR_INVALID_ARGUMENT, "VoyVulkanTargetDesc");
  desc.kind = VOY_TARGET_KIND_HOST_MEMORY;
  refused(VOY_ERROR_INVALID_STRUCTURE, "kind VULKAN");
  images.imageCount = 0;
  refused(VOY_ERROR_INVALID_ARGUMENT, "imageCount");
  images.imageCount = VOY_MAX_VULKAN_IMAGES + 1;
  refused(VOY_ERROR_INVALID_ARGUMENT, "imageCount");
  images.layerCount = 0;
  refused(VOY_ERROR_INVALID_ARGUMENT, "layerCount");
  images.semaphoreCount = 5;
  refused(VOY_ERROR_INVALID_ARGUMENT, "semaphore");
  desc.colorFormat = VOY_COLOR_FORMAT_NONE;
  refused(VOY_ERROR_INVALID_ARGUMENT, "neither");
  desc.colorRowPitch = 4;
  refused(VOY_ERROR_INVALID_ARGUMENT, "pitch");
  VoyVulkanImportedImage passed[2] = {VOY_VULKAN_IMPORTED_IMAGE_INIT,
                                      VOY_VULKAN_IMPORTED_IMAGE_INIT};
  images.images = passed;
  refused(VOY_ERROR_INVALID_ARGUMENT, "images[0].color");
}

TEST_F(Interop, AFrameIsRefusedByWhatIsWrongAndTheNextIsRight) {
  FOR_EACH_MODE({
    VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
    images.imageCount = 1;
    const VoyTarget target = make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images));
    Line line = line_of(target);
    shoot(line, target, 0, eye(target), 4);
    VoyFrameEye at = eye(target);
    VoyVulkanFrame vulkan = line.frame(0);
    VoyFrame frame = VOY_FRAME_INIT;
    frame.eyeCount = 1;
    frame.eyes = &at;
    expect_refused(voyRenderFrame(view, &frame), VOY_ERROR_INVALID_ARGUMENT, "VoyVulkanFrame");
    frame.next = &vulkan;
    vulkan.imageIndex = 1;
    expect_refused(voyRenderFrame(view, &frame), VOY_ERROR_INVALID_ARGUMENT, "imageIndex");
    vulkan = line.frame(0);
    at.layer = 1;
    expect_refused(voyRenderFrame(view, &frame), VOY_ERROR_INVALID_ARGUMENT, "layer");
    at.layer = 0;
    if (found.sync != VOY_VULKAN_SYNC_TIMELINE) {
      vulkan.waitValue = 2;
      expect_refused(voyRenderFrame(view, &frame), VOY_ERROR_INVALID_ARGUMENT, "waitValue");
    } else {  // the value that the frame before has signalled
      expect_refused(voyRenderFrame(view, &frame), VOY_ERROR_INVALID_ARGUMENT, "signalValue");
    }
    VoyEyeDepthLimit limit = VOY_EYE_DEPTH_LIMIT_INIT;
    at.next = &limit;
    expect_refused(voyRenderFrame(view, &frame), VOY_ERROR_INVALID_ARGUMENT,
                   "frame.eyes[0].next.depth: found NULL for a target without "
                   "VoyVulkanTargetDesc.hasDepthLimit");
    EXPECT_EQ(shoot(line, target, 0, eye(target, 1), 4).color,
              expected(VOY_COLOR_FORMAT_RGBA8_UNORM, eye(target, 1), 4).color);
  });
}

TEST_F(Interop, RecordingIsRefusedByWhatIsWrong) {
  ASSERT_TRUE(create());
  VoyVulkanTargetDesc images = VOY_VULKAN_TARGET_DESC_INIT;
  const VoyTarget target = make_target(target_desc(VOY_COLOR_FORMAT_RGBA8_UNORM, &images));
  VkCommandBuffer commands = host->begin();
  VoyVulkanUse used = use(commands, 2);
  expect_refused(voyRecordVulkanAcquire(target, &used), VOY_ERROR_INVALID_ARGUMENT, "imageIndex");
  used = use(VK_NULL_HANDLE, 0);
  expect_refused(voyRecordVulkanRelease(target, &used), VOY_ERROR_INVALID_ARGUMENT,
                 "commandBuffer");
  used = use(commands, 0);
  used.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  expect_refused(voyRecordVulkanAcquire(target, &used), VOY_ERROR_INVALID_ARGUMENT, "layout");
  VoyVulkanDepthLimit limit = VOY_VULKAN_DEPTH_LIMIT_INIT;
  limit.commandBuffer = commands;
  limit.depth = images_of(target)[0].color;
  expect_refused(voyRecordVulkanDepthLimit(target, &limit), VOY_ERROR_INVALID_ARGUMENT,
                 "hasDepthLimit");
  VoyVulkanCopy copy = VOY_VULKAN_COPY_INIT;
  copy.commandBuffer = commands;
  copy.into = images_of(target)[1].color;
  copy.intoFormat = VK_FORMAT_B8G8R8A8_SRGB;
  expect_refused(voyRecordVulkanCopy(target, &copy), VOY_ERROR_UNSUPPORTED, "Composite");
  host->finish(commands);

  VoyTargetDesc memory = VOY_TARGET_DESC_INIT;
  std::vector<uint32_t> pixels(4);
  memory.width = memory.height = 2;
  memory.color = pixels.data();
  const VoyTarget plain = make_target(memory);
  used = use(commands, 0);
  expect_refused(voyRecordVulkanAcquire(plain, &used), VOY_ERROR_INVALID_ARGUMENT, "HOST_MEMORY");
}

}  // namespace
}  // namespace refusal_test
