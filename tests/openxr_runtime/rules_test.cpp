// Each rule of OpenXR's that an application may break is answered with its result, and reported.
#include <limits>

#include "tests/openxr_runtime/client.h"

namespace test_runtime::test {
namespace rules_test {
namespace {

struct Rule {
  const char* name;
  const char* call;  // that reports it
  XrResult result;
  XrResult (*broken)(Client&);  // within a running session that is seen, between two frames
};

std::ostream& operator<<(std::ostream& out, const Rule& rule) {
  return out << rule.name;
}

// A frame up to a layer that keeps every rule; then one thing is wrong with it.
template <class Spoil>
XrResult end_spoilt(Client& client, const Spoil& spoil) {
  EXPECT_EQ(client.wait(), XR_SUCCESS);
  EXPECT_EQ(client.begin(), XR_SUCCESS);
  EXPECT_EQ(client.locate(), XR_SUCCESS);
  client.draw();
  client.make_layer();
  spoil(client);
  return client.end(true);
}

// A swapchain like the colour one, but for one thing.
template <class Spoil>
XrResult create_spoilt(Client& client, const Spoil& spoil) {
  XrSwapchainCreateInfo info =
      client.swapchain_info(VK_FORMAT_R8G8B8A8_UNORM, XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT);
  spoil(info);
  XrSwapchain made = XR_NULL_HANDLE;
  return xrCreateSwapchain(client.session, &info, &made);
}

constexpr Rule kRules[] = {
    {"BeginFrameWithoutWait", "xrBeginFrame", XR_ERROR_CALL_ORDER_INVALID,
     [](Client& client) { return client.begin(); }},
    {"BeginFrameTwice", "xrBeginFrame", XR_ERROR_CALL_ORDER_INVALID,
     [](Client& client) {
       client.wait();
       client.begin();
       return client.begin();
     }},
    {"EndFrameWithoutBegin", "xrEndFrame", XR_ERROR_CALL_ORDER_INVALID,
     [](Client& client) {
       client.wait();
       return client.end(false);
     }},
    {"WaitFrameTwice", "xrWaitFrame", XR_ERROR_CALL_ORDER_INVALID,
     [](Client& client) {
       client.wait();
       return client.wait();
     }},
    {"BeginSessionTwice", "xrBeginSession", XR_ERROR_SESSION_RUNNING,
     [](Client& client) { return client.begin_session(); }},
    {"EndSessionThatIsNotStopping", "xrEndSession", XR_ERROR_SESSION_NOT_STOPPING,
     [](Client& client) { return xrEndSession(client.session); }},
    {"FrameOfASessionThatEnded", "xrWaitFrame", XR_ERROR_SESSION_NOT_RUNNING,
     [](Client& client) {
       EXPECT_EQ(xrRequestExitSession(client.session), XR_SUCCESS);
       EXPECT_EQ(xrEndSession(client.session), XR_SUCCESS);
       return client.wait();
     }},
    {"StaleSession", "xrWaitFrame", XR_ERROR_HANDLE_INVALID,
     [](Client& client) {
       const XrSession stale = client.session;
       client.destroy_session();
       auto state = typed<XrFrameState>(XR_TYPE_FRAME_STATE);
       return xrWaitFrame(stale, nullptr, &state);
     }},
    {"FrameStateOfAnotherType", "xrWaitFrame", XR_ERROR_VALIDATION_FAILURE,
     [](Client& client) {
       auto state = typed<XrFrameState>(XR_TYPE_VIEW);
       return xrWaitFrame(client.session, nullptr, &state);
     }},
    {"WaitImageWithoutAcquire", "xrWaitSwapchainImage", XR_ERROR_CALL_ORDER_INVALID,
     [](Client& client) { return client.wait_image(client.colour); }},
    {"WaitImageTwice", "xrWaitSwapchainImage", XR_ERROR_CALL_ORDER_INVALID,
     [](Client& client) {
       uint32_t index = 0;
       client.acquire(client.colour, index);
       client.acquire(client.colour, index);
       client.wait_image(client.colour);
       return client.wait_image(client.colour);
     }},
    {"ReleaseWithoutWait", "xrReleaseSwapchainImage", XR_ERROR_CALL_ORDER_INVALID,
     [](Client& client) {
       uint32_t index = 0;
       client.acquire(client.colour, index);
       return client.release(client.colour);
     }},
    {"AcquireMoreThanThereAre", "xrAcquireSwapchainImage", XR_ERROR_CALL_ORDER_INVALID,
     [](Client& client) {
       uint32_t index = 0;
       for (int i = 0; i < 3; ++i) EXPECT_EQ(client.acquire(client.colour, index), XR_SUCCESS);
       return client.acquire(client.colour, index);
     }},
    {"LayerOfASwapchainNeverReleased", "xrEndFrame", XR_ERROR_LAYER_INVALID,
     [](Client& client) {
       return end_spoilt(client, [](Client& c) {
         c.layer_views[1].subImage.swapchain =
             c.create_swapchain(VK_FORMAT_R8G8B8A8_UNORM, XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT);
       });
     }},
    {"LayerOfNoSwapchain", "xrEndFrame", XR_ERROR_HANDLE_INVALID,
     [](Client& client) {
       return end_spoilt(client,
                         [](Client& c) { c.layer_views[0].subImage.swapchain = XR_NULL_HANDLE; });
     }},
    {"RectBeyondTheImage", "xrEndFrame", XR_ERROR_SWAPCHAIN_RECT_INVALID,
     [](Client& client) {
       return end_spoilt(client,
                         [](Client& c) { c.layer_views[1].subImage.imageRect.offset.x = 1; });
     }},
    {"RectThatOverflows", "xrEndFrame", XR_ERROR_SWAPCHAIN_RECT_INVALID,
     [](Client& client) {
       return end_spoilt(client, [](Client& c) {
         c.layer_views[0].subImage.imageRect = {{INT32_MAX, 0}, {INT32_MAX, 1}};
       });
     }},
    {"EmptyRect", "xrEndFrame", XR_ERROR_SWAPCHAIN_RECT_INVALID,
     [](Client& client) {
       return end_spoilt(client,
                         [](Client& c) { c.layer_views[0].subImage.imageRect.extent.width = 0; });
     }},
    {"ArrayLayerThatIsNotThere", "xrEndFrame", XR_ERROR_VALIDATION_FAILURE,
     [](Client& client) {
       return end_spoilt(client, [](Client& c) { c.layer_views[1].subImage.imageArrayIndex = 2; });
     }},
    {"PoseThatIsNotNormalised", "xrEndFrame", XR_ERROR_POSE_INVALID,
     [](Client& client) {
       return end_spoilt(client, [](Client& c) { c.layer_views[0].pose.orientation.w += 0.5f; });
     }},
    {"PoseOfZeros", "xrEndFrame", XR_ERROR_POSE_INVALID,
     [](Client& client) {
       return end_spoilt(client, [](Client& c) { c.layer_views[0].pose = {}; });
     }},
    {"PositionThatIsNoNumber", "xrEndFrame", XR_ERROR_POSE_INVALID,
     [](Client& client) {
       return end_spoilt(client, [](Client& c) {
         c.layer_views[0].pose.position.y = std::numeric_limits<float>::quiet_NaN();
       });
     }},
    {"FovBeyondAQuarterTurn", "xrEndFrame", XR_ERROR_VALIDATION_FAILURE,
     [](Client& client) {
       return end_spoilt(client, [](Client& c) { c.layer_views[0].fov.angleLeft = -1.6f; });
     }},
    {"OneViewOnly", "xrEndFrame", XR_ERROR_VALIDATION_FAILURE,
     [](Client& client) { return end_spoilt(client, [](Client& c) { c.layer.viewCount = 1; }); }},
    {"LayerInNoSpace", "xrEndFrame", XR_ERROR_HANDLE_INVALID,
     [](Client& client) {
       return end_spoilt(client, [](Client& c) { c.layer.space = XR_NULL_HANDLE; });
     }},
    {"LayerOfAnUnknownType", "xrEndFrame", XR_ERROR_LAYER_INVALID,
     [](Client& client) {
       return end_spoilt(client, [](Client& c) { c.layer.type = XR_TYPE_VIEW; });
     }},
    {"DepthInAColourFormat", "xrEndFrame", XR_ERROR_VALIDATION_FAILURE,
     [](Client& client) {
       return end_spoilt(client, [](Client& c) { c.depth_info[0].subImage.swapchain = c.colour; });
     }},
    {"ColourInADepthFormat", "xrEndFrame", XR_ERROR_VALIDATION_FAILURE,
     [](Client& client) {
       return end_spoilt(client, [](Client& c) { c.layer_views[0].subImage.swapchain = c.depth; });
     }},
    {"DepthRangeTurnedRound", "xrEndFrame", XR_ERROR_VALIDATION_FAILURE,
     [](Client& client) {
       return end_spoilt(client, [](Client& c) {
         c.depth_info[1].minDepth = 1;
         c.depth_info[1].maxDepth = 0;
       });
     }},
    {"DisplayTimeOfZero", "xrEndFrame", XR_ERROR_TIME_INVALID,
     [](Client& client) {
       return end_spoilt(client, [](Client& c) { c.frame.predictedDisplayTime = 0; });
     }},
    {"LocateAtNoTime", "xrLocateViews", XR_ERROR_TIME_INVALID,
     [](Client& client) {
       client.frame.predictedDisplayTime = 0;
       return client.locate();
     }},
    {"SpaceWithABadPose", "xrCreateReferenceSpace", XR_ERROR_POSE_INVALID,
     [](Client& client) {
       auto info = typed<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
       info.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_LOCAL;
       XrSpace made = XR_NULL_HANDLE;
       return xrCreateReferenceSpace(client.session, &info, &made);
     }},
    {"FormatThatIsNotOffered", "xrCreateSwapchain", XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED,
     [](Client& client) {
       return create_spoilt(client, [](auto& info) { info.format = VK_FORMAT_R8_UNORM; });
     }},
    {"SwapchainOfNoWidth", "xrCreateSwapchain", XR_ERROR_VALIDATION_FAILURE,
     [](Client& client) { return create_spoilt(client, [](auto& info) { info.width = 0; }); }},
    {"SwapchainBeyondTheMaximum", "xrCreateSwapchain", XR_ERROR_VALIDATION_FAILURE,
     [](Client& client) { return create_spoilt(client, [](auto& info) { info.height = 5000; }); }},
    {"StaticImageAcquiredTwice", "xrAcquireSwapchainImage", XR_ERROR_CALL_ORDER_INVALID,
     [](Client& client) {
       XrSwapchainCreateInfo info =
           client.swapchain_info(VK_FORMAT_R8G8B8A8_UNORM, XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT);
       info.createFlags = XR_SWAPCHAIN_CREATE_STATIC_IMAGE_BIT;
       XrSwapchain fixed = XR_NULL_HANDLE;
       EXPECT_EQ(xrCreateSwapchain(client.session, &info, &fixed), XR_SUCCESS);
       uint32_t index = 0;
       EXPECT_EQ(client.acquire(fixed, index), XR_SUCCESS);
       client.wait_image(fixed);
       client.release(fixed);
       return client.acquire(fixed, index);
     }},
};

class Rules : public ::testing::TestWithParam<Rule> {};

TEST_P(Rules, ABrokenOneIsFound) {
  const Rule& rule = GetParam();
  const Stage stage(Json{{"patience_ms", 20}});
  {
    Client client;
    VOYAGER_NEEDS_VULKAN(client);
    client.start();
    for (int i = 0; i < 4; ++i) ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
    EXPECT_EQ(rule.broken(client), rule.result);
  }
  const Json report = stage.report();
  ASSERT_EQ(report["violations"].size(), 1u) << report["violations"];
  EXPECT_EQ(report["violations"][0]["call"], rule.call);
  char name[XR_MAX_RESULT_STRING_SIZE] = "";
  {
    const Client client;
    xrResultToString(client.instance, rule.result, name);
  }
  EXPECT_EQ(report["violations"][0]["result"], name);
}

INSTANTIATE_TEST_SUITE_P(All, Rules, ::testing::ValuesIn(kRules),
                         [](const auto& rule) { return std::string(rule.param.name); });

TEST(Rule, DepthNeedsItsExtension) {
  const Stage stage(Json::object());
  {
    Client client({XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME});
    VOYAGER_NEEDS_VULKAN(client);
    client.start();
    for (int i = 0; i < 3; ++i) ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
    EXPECT_EQ(client.whole_frame(), XR_ERROR_VALIDATION_FAILURE);
  }
  EXPECT_EQ(stage.report()["violations"].size(), 1u);
}

TEST(Rule, ASessionWantsTheRequirementsAskedAndTheRuntimesDevice) {
  const Stage stage(Json::object());
  {
    Client client;
    VOYAGER_NEEDS_VULKAN(client);
    XrGraphicsBindingVulkan2KHR binding = client.vulkan->binding();
    const XrSessionCreateInfo info = {XR_TYPE_SESSION_CREATE_INFO, &binding, 0, client.system};
    EXPECT_EQ(xrCreateSession(client.instance, &info, &client.session),
              XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING);
    auto needed =
        typed<XrGraphicsRequirementsVulkan2KHR>(XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR);
    find<PFN_xrGetVulkanGraphicsRequirements2KHR>(
        client.instance, "xrGetVulkanGraphicsRequirements2KHR")(client.instance, client.system,
                                                                &needed);
    binding.device = VK_NULL_HANDLE;
    EXPECT_EQ(xrCreateSession(client.instance, &info, &client.session),
              XR_ERROR_GRAPHICS_DEVICE_INVALID);
  }
  EXPECT_EQ(stage.report()["violations"].size(), 2u);
}

TEST(Rule, WhatIsLegalAndSeldomMeantIsRemarked) {
  const Stage stage(Json::object());
  {
    Client client;
    VOYAGER_NEEDS_VULKAN(client);
    client.start();
    for (int i = 0; i < 4; ++i) ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
    client.wait();
    client.begin();
    EXPECT_EQ(client.end(true), XR_SUCCESS);  // with the images of the frame before
  }
  const Json report = stage.report();
  EXPECT_EQ(report["violations"].size(), 0u);
  ASSERT_EQ(report["remarks"].size(), 1u);
  EXPECT_EQ(report["remarks"][0]["frame"], 4);
}

// The layout is the application's to restore: Vulkan's own layer tells.
TEST(Rule, AnImageReleasedInAnotherLayoutIsTold) {
  if (!has_validation_layer())
    VOYAGER_SKIP_WITHOUT(VULKAN, "the Vulkan validation layer is not here");
  const Stage stage(Json::object());
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  client.start();
  for (int i = 0; i < 3; ++i) ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
  ASSERT_EQ(client.wait(), XR_SUCCESS);
  ASSERT_EQ(client.begin(), XR_SUCCESS);
  ASSERT_EQ(client.locate(), XR_SUCCESS);
  client.vulkan->home = VK_IMAGE_LAYOUT_GENERAL;
  client.draw();
  client.make_layer();
  EXPECT_EQ(client.end(true), XR_SUCCESS);
  EXPECT_GT(client.vulkan->messages, 0);
  client.vulkan->messages = 0;
}

}  // namespace
}  // namespace rules_test
}  // namespace test_runtime::test
