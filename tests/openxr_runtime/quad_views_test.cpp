// XR_VARJO_quad_views: four views, left, right, left inner, right inner.
#include <cmath>

#include "tests/openxr_runtime/client.h"

namespace test_runtime::test {
namespace quad_views_test {
namespace {

constexpr XrViewConfigurationType kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
constexpr XrViewConfigurationType kQuad = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO;

std::vector<const char*> with_quad_views() {
  std::vector<const char*> extensions = kAllExtensions;
  extensions.push_back(XR_VARJO_QUAD_VIEWS_EXTENSION_NAME);
  return extensions;
}

std::vector<XrViewConfigurationType> configurations(const Client& client) {
  uint32_t count = 0;
  EXPECT_EQ(xrEnumerateViewConfigurations(client.instance, client.system, 0, &count, nullptr),
            XR_SUCCESS);
  std::vector<XrViewConfigurationType> found(count);
  EXPECT_EQ(
      xrEnumerateViewConfigurations(client.instance, client.system, count, &count, found.data()),
      XR_SUCCESS);
  return found;
}

XrResult sizes(const Client& client, XrViewConfigurationType type,
               std::vector<XrViewConfigurationView>& views, uint32_t& count) {
  for (auto& view : views) view = typed<XrViewConfigurationView>(XR_TYPE_VIEW_CONFIGURATION_VIEW);
  return xrEnumerateViewConfigurationViews(client.instance, client.system, type,
                                           static_cast<uint32_t>(views.size()), &count,
                                           views.data());
}

TEST(QuadViews, AreThereWithTheirExtension) {
  const Stage stage(Json{{"recommended", {{40, 41}, {42, 43}, {44, 45}, {46, 47}}}});
  std::vector<XrViewConfigurationView> views(4);
  uint32_t count = 0;
  {
    const Client client;
    EXPECT_EQ(configurations(client), std::vector({kStereo}));
    EXPECT_EQ(sizes(client, kQuad, views, count), XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
  }
  const Client client(with_quad_views());
  EXPECT_EQ(configurations(client), std::vector({kQuad, kStereo}));
  ASSERT_EQ(sizes(client, kQuad, views, count), XR_SUCCESS);
  ASSERT_EQ(count, 4u);
  for (uint32_t i = 0; i < 4; ++i) {
    EXPECT_EQ(views[i].recommendedImageRectWidth, 40 + 2 * i);
    EXPECT_EQ(views[i].recommendedImageRectHeight, 41 + 2 * i);
  }
  views.resize(2);
  EXPECT_EQ(sizes(client, kQuad, views, count), XR_ERROR_SIZE_INSUFFICIENT);
  EXPECT_EQ(count, 4u);
  ASSERT_EQ(sizes(client, kStereo, views, count), XR_SUCCESS);
  EXPECT_EQ(count, 2u);
}

TEST(QuadViews, ARuntimeMayBeWithoutThem) {
  const Stage stage(Json{{"extensions", Json::array()}});
  const std::vector<const char*> extensions = {XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME,
                                               XR_VARJO_QUAD_VIEWS_EXTENSION_NAME};
  const XrInstanceCreateInfo info = instance_info(extensions);
  XrInstance instance = XR_NULL_HANDLE;
  EXPECT_EQ(xrCreateInstance(&info, &instance), XR_ERROR_EXTENSION_NOT_PRESENT);
}

TEST(QuadViews, InnerOnesAreTheMiddleOfAnEye) {
  const Stage stage(Json::object());
  Client client(with_quad_views());
  VOYAGER_NEEDS_VULKAN(client);
  client.configuration = kQuad;
  client.start();
  for (int i = 0; i < 6; ++i) ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
  for (int eye = 0; eye < 2; ++eye) {
    const XrView &outer = client.views[eye], &inner = client.views[2 + eye];
    EXPECT_EQ(std::memcmp(&outer.pose, &inner.pose, sizeof outer.pose), 0);
    for (const auto angle :
         {&XrFovf::angleLeft, &XrFovf::angleRight, &XrFovf::angleUp, &XrFovf::angleDown})
      EXPECT_NEAR(std::tan(inner.fov.*angle), 0.375f * std::tan(outer.fov.*angle), 1e-5f);
  }
  EXPECT_LT(client.views[2].pose.position.x, client.views[3].pose.position.x);
}

TEST(QuadViews, AreCapturedInTheirOrder) {
  const Stage stage(Json{{"events", {{{"frame", 6}, {"do", "exit"}}}}});
  {
    Client client(with_quad_views());
    VOYAGER_NEEDS_VULKAN(client);
    client.configuration = kQuad;
    client.create_session();
    client.create_swapchains();
    EXPECT_TRUE(client.run(100));
  }
  const Json report = stage.report();
  EXPECT_EQ(report["violations"], Json::array());
  EXPECT_EQ(report["remarks"], Json::array());
  EXPECT_EQ(report["captures"][0]["images"],
            Json({"0000_L", "0000_R", "0000_L_inner", "0000_R_inner"}));
  const Json cameras = stage.read("shown/cameras.json");
  ASSERT_EQ(cameras.size(), 4 * report["captures"].size());
  EXPECT_EQ(cameras[2]["img_name"], "0000_L_inner");
  EXPECT_NEAR(cameras[2]["fx"].get<double>() * 0.375, cameras[0]["fx"], 1e-3);
}

// With the reported call and result.
void expect_refused(const Stage& stage, const char* call, const char* result) {
  const Json report = stage.report();
  ASSERT_EQ(report["violations"].size(), 1u) << report["violations"];
  EXPECT_EQ(report["violations"][0]["call"], call);
  EXPECT_EQ(report["violations"][0]["result"], result);
}

TEST(QuadViews, AreNotBegunWithoutTheirExtension) {
  const Stage stage(Json::object());
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  client.configuration = kQuad;
  client.create_session();
  client.poll();
  EXPECT_EQ(client.begin_session(), XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED);
  expect_refused(stage, "xrBeginSession", "XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED");
}

// A layer has the views that the session was begun with, no fewer and no more.
TEST(QuadViews, LayersOfAnotherCountAreRefused) {
  for (const XrViewConfigurationType begun : {kQuad, kStereo}) {
    const Stage stage(Json::object());
    Client client(with_quad_views());
    VOYAGER_NEEDS_VULKAN(client);
    client.configuration = begun;
    client.start();
    for (int i = 0; i < 4; ++i) ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
    ASSERT_EQ(client.wait(), XR_SUCCESS);
    ASSERT_EQ(client.begin(), XR_SUCCESS);
    client.configuration = begun == kQuad ? kStereo : kQuad;
    ASSERT_EQ(client.locate(), XR_SUCCESS);  // may be asked for; it is remarked
    client.draw();
    client.make_layer();
    EXPECT_EQ(client.end(true), XR_ERROR_VALIDATION_FAILURE);
    expect_refused(stage, "xrEndFrame", "XR_ERROR_VALIDATION_FAILURE");
  }
}

TEST(QuadViews, NothingOfAnInnerOneIsMasked) {
  const Stage stage(Json::object());
  Client client(with_quad_views());
  VOYAGER_NEEDS_VULKAN(client);
  client.configuration = kQuad;
  client.start();
  const auto get = find<PFN_xrGetVisibilityMaskKHR>(client.instance, "xrGetVisibilityMaskKHR");
  const auto hidden = XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR;
  auto mask = typed<XrVisibilityMaskKHR>(XR_TYPE_VISIBILITY_MASK_KHR);
  for (uint32_t view = 0; view < 4; ++view) {
    ASSERT_EQ(get(client.session, kQuad, view, hidden, &mask), XR_SUCCESS);
    EXPECT_EQ(mask.indexCountOutput, view < 2 ? 12u : 0u);
  }
  EXPECT_EQ(get(client.session, kQuad, 4, hidden, &mask), XR_ERROR_INDEX_OUT_OF_RANGE);
  EXPECT_EQ(get(client.session, kStereo, 2, hidden, &mask), XR_ERROR_INDEX_OUT_OF_RANGE);
}

}  // namespace
}  // namespace quad_views_test
}  // namespace test_runtime::test
