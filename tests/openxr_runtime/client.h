#pragma once
// A small OpenXR application, through the real loader, that keeps every rule unless a test makes
// it break one.
#include <cstdlib>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "tests/openxr_runtime/vulkan_client.h"
#include "tests/support/needs.h"
#include "tests/support/test_support.h"

namespace test_runtime::test {

using Json = nlohmann::json;

// Where a script and what the runtime writes are.
class Stage {
 public:
  explicit Stage(Json script) {
    script["report"] = "report.json";
    script["output"] = "shown";
    std::ofstream(folder_.file("script.json")) << script;
    ::setenv("XR_RUNTIME_JSON", VOYAGER_BIN_DIR "/../lib/voyager_test_runtime.json", 1);
    ::setenv("VOYAGER_TEST_RUNTIME_SCRIPT", folder_.file("script.json").c_str(), 1);
  }
  std::string file(const std::string& name) const { return folder_.file(name); }
  Json read(const std::string& name) const {
    std::ifstream file(folder_.file(name));
    return Json::parse(file, nullptr, false);
  }
  Json report() const { return read("report.json"); }

 private:
  voyager::test::TempFolder folder_;
};

inline const std::vector<const char*> kAllExtensions = {
    XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME, XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME,
    XR_KHR_VISIBILITY_MASK_EXTENSION_NAME};

// Keeps pointers to both.
inline XrInstanceCreateInfo instance_info(const std::vector<const char*>& extensions,
                                          const std::vector<const char*>& layers = {}) {
  auto info = typed<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
  std::strcpy(info.applicationInfo.applicationName, "client");
  info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.enabledExtensionNames = extensions.data();
  info.enabledApiLayerCount = static_cast<uint32_t>(layers.size());
  info.enabledApiLayerNames = layers.data();
  return info;
}

class Client {
 public:
  explicit Client(const std::vector<const char*>& extensions = kAllExtensions,
                  const std::vector<const char*>& layers = {}) {
    const XrInstanceCreateInfo info = instance_info(extensions, layers);
    EXPECT_EQ(xrCreateInstance(&info, &instance), XR_SUCCESS);
    if (!instance) return;
    const XrSystemGetInfo get = {XR_TYPE_SYSTEM_GET_INFO, nullptr,
                                 XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY};
    EXPECT_EQ(xrGetSystem(instance, &get, &system), XR_SUCCESS);
    vulkan = std::make_unique<VulkanClient>(instance, system);
  }
  ~Client() {
    destroy_session();
    const int before = messages();
    vulkan.reset();
    EXPECT_EQ(before, 0) << "messages of the Vulkan validation layer";
    if (instance) {
      EXPECT_EQ(xrDestroyInstance(instance), XR_SUCCESS);
    }
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  bool has_vulkan() const { return vulkan && vulkan->device; }
  int messages() const { return vulkan ? vulkan->messages : 0; }

  void create_session() {
    auto needed =
        typed<XrGraphicsRequirementsVulkan2KHR>(XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR);
    ASSERT_EQ(find<PFN_xrGetVulkanGraphicsRequirements2KHR>(
                  instance, "xrGetVulkanGraphicsRequirements2KHR")(instance, system, &needed),
              XR_SUCCESS);
    const XrGraphicsBindingVulkan2KHR binding = vulkan->binding();
    const XrSessionCreateInfo info = {XR_TYPE_SESSION_CREATE_INFO, &binding, 0, system};
    ASSERT_EQ(xrCreateSession(instance, &info, &session), XR_SUCCESS);
    auto local = typed<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
    local.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_LOCAL;
    local.poseInReferenceSpace.orientation.w = 1;
    ASSERT_EQ(xrCreateReferenceSpace(session, &local, &space), XR_SUCCESS);
  }
  void create_swapchains() {
    colour = create_swapchain(VK_FORMAT_R8G8B8A8_UNORM, XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT);
    depth = create_swapchain(VK_FORMAT_D32_SFLOAT, XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  }
  XrSwapchainCreateInfo swapchain_info(int64_t format, XrSwapchainUsageFlags usage) const {
    return {XR_TYPE_SWAPCHAIN_CREATE_INFO,
            nullptr,
            0,
            usage | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT,
            format,
            1,
            kWidth,
            kHeight,
            1,
            2,
            1};
  }
  XrSwapchain create_swapchain(int64_t format, XrSwapchainUsageFlags usage) {
    const XrSwapchainCreateInfo info = swapchain_info(format, usage);
    XrSwapchain made = XR_NULL_HANDLE;
    EXPECT_EQ(xrCreateSwapchain(session, &info, &made), XR_SUCCESS);
    return made;
  }
  void destroy_session() {
    if (vulkan && vulkan->device) vkDeviceWaitIdle(vulkan->device);
    if (session) {
      EXPECT_EQ(xrDestroySession(session), XR_SUCCESS);
    }
    session = XR_NULL_HANDLE;
  }
  // Created, with swapchains, and begun.
  void start() {
    create_session();
    create_swapchains();
    poll();
    ASSERT_EQ(state, XR_SESSION_STATE_READY);
    ASSERT_EQ(begin_session(), XR_SUCCESS);
  }

  XrResult begin_session() {
    const XrSessionBeginInfo info = {XR_TYPE_SESSION_BEGIN_INFO, nullptr, configuration};
    return xrBeginSession(session, &info);
  }
  // Every event that waits.
  void poll() {
    auto event = typed<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
    while (xrPollEvent(instance, &event) == XR_SUCCESS) {
      events.push_back(event.type);
      if (event.type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED)
        state = reinterpret_cast<const XrEventDataSessionStateChanged&>(event).state;
      event = typed<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
    }
  }

  XrResult wait() {
    frame = typed<XrFrameState>(XR_TYPE_FRAME_STATE);
    return xrWaitFrame(session, nullptr, &frame);
  }
  XrResult begin() { return xrBeginFrame(session, nullptr); }
  XrResult locate() {
    const XrViewLocateInfo info = {XR_TYPE_VIEW_LOCATE_INFO, nullptr, configuration,
                                   frame.predictedDisplayTime, space};
    view_state = typed<XrViewState>(XR_TYPE_VIEW_STATE);
    for (XrView& view : views) view = typed<XrView>(XR_TYPE_VIEW);
    uint32_t count = 0;
    return xrLocateViews(session, &info, &view_state, view_count(), &count, views);
  }

  XrResult acquire(XrSwapchain swapchain, uint32_t& index) {
    return xrAcquireSwapchainImage(swapchain, nullptr, &index);
  }
  XrResult wait_image(XrSwapchain swapchain, XrDuration timeout = XR_INFINITE_DURATION) {
    const XrSwapchainImageWaitInfo info = {XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr, timeout};
    return xrWaitSwapchainImage(swapchain, &info);
  }
  XrResult release(XrSwapchain swapchain) { return xrReleaseSwapchainImage(swapchain, nullptr); }
  VkImage image(XrSwapchain swapchain, uint32_t index) {
    uint32_t count = 0;
    xrEnumerateSwapchainImages(swapchain, 0, &count, nullptr);
    std::vector images(count,
                       typed<XrSwapchainImageVulkan2KHR>(XR_TYPE_SWAPCHAIN_IMAGE_VULKAN2_KHR));
    xrEnumerateSwapchainImages(swapchain, count, &count,
                               reinterpret_cast<XrSwapchainImageBaseHeader*>(images.data()));
    return images[index].image;
  }

  // Both eyes, each in its colour, or at its depth.
  void draw() {
    uint32_t index = 0;
    ASSERT_EQ(acquire(colour, index), XR_SUCCESS);
    ASSERT_EQ(wait_image(colour), XR_SUCCESS);
    const VkImage painted = image(colour, index);
    vulkan->fill(painted, false, 2, [&](VkCommandBuffer commands) {
      for (uint32_t eye = 0; eye < 2; ++eye) {
        const VkImageSubresourceRange one = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, eye, 1};
        vkCmdClearColorImage(commands, painted, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &paint[eye],
                             1, &one);
      }
    });
    ASSERT_EQ(release(colour), XR_SUCCESS);
    ASSERT_EQ(acquire(depth, index), XR_SUCCESS);
    ASSERT_EQ(wait_image(depth), XR_SUCCESS);
    const VkImage deep = image(depth, index);
    vulkan->fill(deep, true, 2, [&](VkCommandBuffer commands) {
      const VkClearDepthStencilValue value = {0.5f, 0};
      const VkImageSubresourceRange all = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 2};
      vkCmdClearDepthStencilImage(commands, deep, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &value, 1,
                                  &all);
    });
    ASSERT_EQ(release(depth), XR_SUCCESS);
  }

  uint32_t view_count() const {
    return configuration == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO ? 4 : 2;
  }
  // The layer of the views located last; tests alter it before end().
  void make_layer() {
    for (uint32_t i = 0; i < view_count(); ++i) {
      const XrRect2Di whole = {{0, 0}, {int32_t{kWidth}, int32_t{kHeight}}};
      depth_info[i] = {XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR,
                       nullptr,
                       {depth, whole, i % 2},
                       0,
                       1,
                       0.1f,
                       INFINITY};
      layer_views[i] = {XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW,
                        with_depth ? &depth_info[i] : nullptr,
                        views[i].pose,
                        views[i].fov,
                        {colour, whole, i % 2}};
    }
    layer = {XR_TYPE_COMPOSITION_LAYER_PROJECTION, nullptr, 0, space, view_count(), layer_views};
  }
  XrResult end(bool with_layer) {
    const XrCompositionLayerBaseHeader* layers[] = {
        reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer)};
    const XrFrameEndInfo info = {XR_TYPE_FRAME_END_INFO,     nullptr,
                                 frame.predictedDisplayTime, XR_ENVIRONMENT_BLEND_MODE_OPAQUE,
                                 with_layer ? 1u : 0u,       layers};
    return xrEndFrame(session, &info);
  }
  // As an application does it; the result of the call that did not succeed, if any.
  XrResult whole_frame() {
    XrResult result = wait();
    if (XR_SUCCEEDED(result)) result = begin();
    if (XR_FAILED(result)) return result;
    if (!frame.shouldRender) return end(false);
    result = locate();
    if (XR_FAILED(result)) return result;
    draw();
    make_layer();
    return end(true);
  }
  // Frames, with what a session's states ask for; true once the session is over.
  bool run(int frames) {
    for (int i = 0; i < frames; ++i) {
      poll();
      if (state == XR_SESSION_STATE_EXITING || state == XR_SESSION_STATE_LOSS_PENDING) return true;
      if (state == XR_SESSION_STATE_READY && !running) running = begin_session() == XR_SUCCESS;
      if (state == XR_SESSION_STATE_STOPPING) {
        EXPECT_EQ(xrEndSession(session), XR_SUCCESS);
        running = false;
      }
      if (running) {
        EXPECT_GE(whole_frame(), 0);
      }
    }
    return false;
  }

  static constexpr uint32_t kWidth = 20, kHeight = 12;

  XrInstance instance = XR_NULL_HANDLE;
  XrSystemId system = 0;
  std::unique_ptr<VulkanClient> vulkan;
  XrSession session = XR_NULL_HANDLE;
  XrSpace space = XR_NULL_HANDLE;
  XrSwapchain colour = XR_NULL_HANDLE, depth = XR_NULL_HANDLE;
  XrSessionState state = XR_SESSION_STATE_UNKNOWN;
  bool running = false;
  XrViewConfigurationType configuration = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
  std::vector<XrStructureType> events;
  XrFrameState frame = {};
  XrViewState view_state = {};
  XrView views[4] = {};
  VkClearColorValue paint[2] = {{{0.2f, 0.4f, 0.6f, 1}}, {{1, 0, 0.8f, 1}}};
  bool with_depth = true;
  XrCompositionLayerDepthInfoKHR depth_info[4] = {};
  XrCompositionLayerProjectionView layer_views[4] = {};
  XrCompositionLayerProjection layer = {};
};

// Skips, with the reason, where there is no Vulkan.
#define VOYAGER_NEEDS_VULKAN(client) \
  if (!(client).has_vulkan())        \
  VOYAGER_SKIP_WITHOUT(VULKAN, "found no Vulkan device: lavapipe would do")

}  // namespace test_runtime::test
