// What the application is told of head, spaces and hands.
#include <algorithm>
#include <cmath>

#include "tests/openxr_runtime/client.h"

namespace test_runtime::test {
namespace views_test {
namespace {

XrPosef located(const Client& client, XrReferenceSpaceType type, XrTime time) {
  auto info = typed<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
  info.referenceSpaceType = type;
  info.poseInReferenceSpace.orientation.w = 1;
  XrSpace space = XR_NULL_HANDLE;
  EXPECT_EQ(xrCreateReferenceSpace(client.session, &info, &space), XR_SUCCESS);
  auto location = typed<XrSpaceLocation>(XR_TYPE_SPACE_LOCATION);
  EXPECT_EQ(xrLocateSpace(space, client.space, time, &location), XR_SUCCESS);
  EXPECT_EQ(xrDestroySpace(space), XR_SUCCESS);
  return location.pose;
}

TEST(Views, FrustaAreOffCentreAndChangeEveryFrame) {
  const Stage stage(Json::object());
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  client.start();
  XrFovf last = {};
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
    ASSERT_EQ(client.locate(), XR_SUCCESS);
    EXPECT_EQ(client.view_state.viewStateFlags, 15u);
    EXPECT_LT(client.views[0].fov.angleLeft, -1.2f * client.views[0].fov.angleRight);
    EXPECT_GT(client.views[1].fov.angleRight, -1.2f * client.views[1].fov.angleLeft);
    EXPECT_NE(client.views[0].fov.angleLeft, last.angleLeft);
    last = client.views[0].fov;
    const XrVector3f l = client.views[0].pose.position, r = client.views[1].pose.position;
    EXPECT_NEAR(std::hypot(r.x - l.x, r.y - l.y, r.z - l.z), 0.064f, 1e-5f);
  }
}

TEST(Views, ALostPositionIsNotValid) {
  const Stage stage(Json{{"position_lost_frames", {{4, 1}}}, {"tracking_lost_frames", {{5, 1}}}});
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  client.start();
  const XrViewStateFlags orientation =
      XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_ORIENTATION_TRACKED_BIT;
  for (int i = 0; i < 7; ++i) {
    ASSERT_EQ(client.wait(), XR_SUCCESS);
    ASSERT_EQ(client.begin(), XR_SUCCESS);
    ASSERT_EQ(client.locate(), XR_SUCCESS);
    EXPECT_EQ(client.view_state.viewStateFlags, i == 4 ? orientation : i == 5 ? 0 : 15u);
    ASSERT_EQ(client.end(false), XR_SUCCESS);
  }
}

TEST(Views, RecommendedSizesAreTheScripts) {
  const Stage stage(Json{{"recommended", {{1, 1}, {1023, 771}}}});
  const Client client;
  auto view = typed<XrViewConfigurationView>(XR_TYPE_VIEW_CONFIGURATION_VIEW);
  XrViewConfigurationView views[2] = {view, view};
  uint32_t count = 0;
  const auto type = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
  EXPECT_EQ(
      xrEnumerateViewConfigurationViews(client.instance, client.system, type, 1, &count, views),
      XR_ERROR_SIZE_INSUFFICIENT);
  EXPECT_EQ(
      xrEnumerateViewConfigurationViews(client.instance, client.system, type, 2, &count, views),
      XR_SUCCESS);
  EXPECT_EQ(views[0].recommendedImageRectWidth, 1u);
  EXPECT_EQ(views[1].recommendedImageRectWidth, 1023u);
  EXPECT_EQ(views[1].recommendedImageRectHeight, 771u);
}

TEST(Spaces, TheHeadIsBetweenTheEyesAndTheFloorBelow) {
  const Stage stage(Json::object());
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  client.start();
  ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
  ASSERT_EQ(client.locate(), XR_SUCCESS);
  const XrTime time = client.frame.predictedDisplayTime;
  const XrPosef head = located(client, XR_REFERENCE_SPACE_TYPE_VIEW, time);
  EXPECT_NEAR(head.position.x,
              (client.views[0].pose.position.x + client.views[1].pose.position.x) / 2, 1e-6f);
  EXPECT_NEAR(located(client, XR_REFERENCE_SPACE_TYPE_STAGE, time).position.y, -1.6f, 1e-6f);
}

// LOCAL moves a metre up and half a turn about y at the time that the event names.
TEST(Spaces, ARecentringIsToldBeforeItHappens) {
  const Stage stage(Json{{"events",
                          {{{"frame", 2},
                            {"do", "recentre"},
                            {"position", {0, 1, 0}},
                            {"orientation", {0, 1, 0, 0}}}}}});
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  client.start();
  for (int i = 0; i < 3; ++i) ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
  auto event = typed<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
  while (event.type != XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING) {
    event = typed<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
    ASSERT_EQ(xrPollEvent(client.instance, &event), XR_SUCCESS);
  }
  const auto& change = reinterpret_cast<const XrEventDataReferenceSpaceChangePending&>(event);
  EXPECT_NEAR(change.poseInPreviousSpace.position.y, 1, 1e-6f);
  const auto floor_at = [&](XrTime time) {
    return located(client, XR_REFERENCE_SPACE_TYPE_STAGE, time).position.y;
  };
  EXPECT_NEAR(floor_at(change.changeTime - 1), -1.6f, 1e-6f);
  EXPECT_NEAR(floor_at(change.changeTime), -2.6f, 1e-6f);
}

TEST(Masks, HiddenTrianglesLieAtTheCornersAndTheSwitchWorks) {
  const Stage stage(Json::object());
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  client.start();
  const auto get = find<PFN_xrGetVisibilityMaskKHR>(client.instance, "xrGetVisibilityMaskKHR");
  auto mask = typed<XrVisibilityMaskKHR>(XR_TYPE_VISIBILITY_MASK_KHR);
  const auto type = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
  const auto hidden = XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR;
  ASSERT_EQ(get(client.session, type, 0, hidden, &mask), XR_SUCCESS);
  std::vector<XrVector2f> vertices(mask.vertexCountOutput);
  std::vector<uint32_t> indices(mask.indexCountOutput);
  EXPECT_EQ(indices.size(), 12u);
  mask.vertexCapacityInput = mask.vertexCountOutput;
  mask.indexCapacityInput = mask.indexCountOutput;
  mask.vertices = vertices.data();
  mask.indices = indices.data();
  ASSERT_EQ(get(client.session, type, 0, hidden, &mask), XR_SUCCESS);
  for (size_t i = 0; i < indices.size(); i += 3) {  // counter-clockwise, and away from the middle
    const XrVector2f a = vertices[indices[i]], b = vertices[indices[i + 1]],
                     c = vertices[indices[i + 2]];
    EXPECT_GT((b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x), 0);
    for (const XrVector2f& corner : {a, b, c}) EXPECT_GT(std::hypot(corner.x, corner.y), 0.5f);
  }
}

class Hands : public ::testing::Test {
 protected:
  static XrPath path(const Client& client, const char* text) {
    XrPath made = XR_NULL_PATH;
    EXPECT_EQ(xrStringToPath(client.instance, text, &made), XR_SUCCESS) << text;
    return made;
  }
  void make_actions(const Client& client) {
    auto set = typed<XrActionSetCreateInfo>(XR_TYPE_ACTION_SET_CREATE_INFO);
    std::strcpy(set.actionSetName, "walk");
    std::strcpy(set.localizedActionSetName, "Walk");
    ASSERT_EQ(xrCreateActionSet(client.instance, &set, &set_), XR_SUCCESS);
    auto action = typed<XrActionCreateInfo>(XR_TYPE_ACTION_CREATE_INFO);
    std::strcpy(action.actionName, "move");
    std::strcpy(action.localizedActionName, "Move");
    action.actionType = XR_ACTION_TYPE_VECTOR2F_INPUT;
    ASSERT_EQ(xrCreateAction(set_, &action, &move_), XR_SUCCESS);
  }
  XrResult suggest(const Client& client, const char* profile, const char* source) {
    const XrActionSuggestedBinding binding = {move_, path(client, source)};
    const XrInteractionProfileSuggestedBinding info = {
        XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING, nullptr, path(client, profile), 1, &binding};
    return xrSuggestInteractionProfileBindings(client.instance, &info);
  }
  XrResult attach(const Client& client) {
    const XrSessionActionSetsAttachInfo info = {XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO, nullptr, 1,
                                                &set_};
    return xrAttachSessionActionSets(client.session, &info);
  }
  XrResult sync(const Client& client) {
    const XrActiveActionSet active = {set_, XR_NULL_PATH};
    const XrActionsSyncInfo info = {XR_TYPE_ACTIONS_SYNC_INFO, nullptr, 1, &active};
    return xrSyncActions(client.session, &info);
  }
  XrActionStateVector2f state(const Client& client) {
    const XrActionStateGetInfo info = {XR_TYPE_ACTION_STATE_GET_INFO, nullptr, move_, XR_NULL_PATH};
    auto found = typed<XrActionStateVector2f>(XR_TYPE_ACTION_STATE_VECTOR2F);
    EXPECT_EQ(xrGetActionStateVector2f(client.session, &info, &found), XR_SUCCESS);
    return found;
  }

  XrActionSet set_ = XR_NULL_HANDLE;
  XrAction move_ = XR_NULL_HANDLE;
};

TEST_F(Hands, AThumbstickFollowsTheScript) {
  const char* stick = "/user/hand/left/input/thumbstick";
  const Stage stage(
      Json{{"input",
            {{{"frame", 5}, {stick, {0.25, -0.5}}}, {{"frame", 7}, {"/user/hand/left", false}}}}});
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  make_actions(client);
  EXPECT_EQ(suggest(client, "/interaction_profiles/khr/simple_controller", stick),
            XR_ERROR_PATH_UNSUPPORTED);
  EXPECT_EQ(suggest(client, "/interaction_profiles/oculus/touch_controller", stick), XR_SUCCESS);
  client.start();
  ASSERT_EQ(attach(client), XR_SUCCESS);
  EXPECT_EQ(sync(client), XR_SESSION_NOT_FOCUSED);
  for (int i = 0; i < 8; ++i) {
    ASSERT_EQ(client.whole_frame(), XR_SUCCESS);
    const XrResult synced = sync(client);
    EXPECT_EQ(synced, i < 2 ? XR_SESSION_NOT_FOCUSED : XR_SUCCESS) << i;
    const XrActionStateVector2f found = state(client);
    EXPECT_EQ(found.isActive, static_cast<XrBool32>(i >= 2 && i < 7)) << i;
    EXPECT_EQ(found.currentState.x, i == 5 || i == 6 ? 0.25f : 0.0f) << i;
    EXPECT_EQ(found.currentState.y, i == 5 || i == 6 ? -0.5f : 0.0f) << i;
    EXPECT_EQ(found.changedSinceLastSync, static_cast<XrBool32>(i == 5)) << i;
  }
  client.poll();
  EXPECT_EQ(std::count(client.events.begin(), client.events.end(),
                       XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED),
            1);
}

TEST_F(Hands, ActionsAreAttachedOnce) {
  const Stage stage(Json::object());
  Client client;
  VOYAGER_NEEDS_VULKAN(client);
  make_actions(client);
  client.start();
  const XrActionStateGetInfo info = {XR_TYPE_ACTION_STATE_GET_INFO, nullptr, move_, XR_NULL_PATH};
  auto vector = typed<XrActionStateVector2f>(XR_TYPE_ACTION_STATE_VECTOR2F);
  EXPECT_EQ(xrGetActionStateVector2f(client.session, &info, &vector),
            XR_ERROR_ACTIONSET_NOT_ATTACHED);
  EXPECT_EQ(sync(client), XR_ERROR_ACTIONSET_NOT_ATTACHED);
  EXPECT_EQ(attach(client), XR_SUCCESS);
  EXPECT_EQ(attach(client), XR_ERROR_ACTIONSETS_ALREADY_ATTACHED);
  auto press = typed<XrActionStateBoolean>(XR_TYPE_ACTION_STATE_BOOLEAN);
  EXPECT_EQ(xrGetActionStateBoolean(client.session, &info, &press), XR_ERROR_ACTION_TYPE_MISMATCH);
}

}  // namespace
}  // namespace views_test
}  // namespace test_runtime::test
