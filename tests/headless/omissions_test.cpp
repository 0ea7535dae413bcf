// What a host is told of a scene's profile and of what a view does without.
#include <cstring>

#include "hostile.h"

namespace {

using ListedOmissions = Hostile;

// The scene is flat, of SH degree 1.
TEST_F(ListedOmissions, AProfileIsFilledThroughTheChain) {
  VoySceneProfile profile = VOY_SCENE_PROFILE_INIT;
  profile.reserved = profile.merged = 7;
  VoySceneInfo info = VOY_SCENE_INFO_INIT;
  info.next = &profile;
  ASSERT_EQ(voy.GetSceneInfo(host.scene, &info), VOY_SUCCESS) << voy.message();
  EXPECT_EQ(info.next, &profile);
  EXPECT_EQ(info.shDegree, 1u);
  EXPECT_EQ(profile.inputShDegree, 1u);
  EXPECT_EQ(profile.complete, 1u);
  EXPECT_EQ(profile.merged + profile.interpolated + profile.streamed + profile.reserved, 0u);
  EXPECT_GE(profile.leastAnisotropy, 1.0f);
  EXPECT_GE(profile.greatestAnisotropy, profile.leastAnisotropy);
  profile.type = VOY_STRUCTURE_TYPE_FRAME;
  expect_refused(voy.GetSceneInfo(host.scene, &info), VOY_ERROR_INVALID_STRUCTURE, "expected 33");
}

TEST_F(ListedOmissions, AViewListsItsScenesAndItsOwn) {
  ASSERT_EQ(host.render(), VOY_SUCCESS) << voy.message();
  uint32_t count = 0;
  ASSERT_EQ(voy.GetViewOmissions(host.view, 0, nullptr, &count), VOY_SUCCESS);
  // The tree, SH bands above degree 1, a second eye; depth was asked for.
  ASSERT_EQ(count, 3u);
  VoyOmission omissions[4] = {};
  EXPECT_EQ(voy.GetViewOmissions(host.view, 1, omissions, &count), VOY_INCOMPLETE);
  EXPECT_EQ(omissions[1].what[0], '\0');
  ASSERT_EQ(voy.GetViewOmissions(host.view, 4, omissions, &count), VOY_SUCCESS);
  EXPECT_STREQ(omissions[0].what, "tree and search");
  EXPECT_STREQ(omissions[1].what, "SH bands above degree 1");
  EXPECT_STREQ(omissions[2].what, "second eye");
  for (uint32_t i = 0; i < count; ++i) {
    EXPECT_EQ(omissions[i].type, VOY_STRUCTURE_TYPE_OMISSION);
    EXPECT_GT(omissions[i].bytes, 0u);
    EXPECT_EQ(omissions[i].milliseconds, 0.0) << "a host's memory has no rate that is known";
    EXPECT_NE(std::strlen(omissions[i].why), 0u);
  }
}

TEST_F(ListedOmissions, AreRefusedByNameWhereTheCallIsWrong) {
  uint32_t count = 0;
  expect_refused(voy.GetViewOmissions(nullptr, 0, nullptr, &count), VOY_ERROR_INVALID_HANDLE,
                 "found NULL");
  expect_refused(voy.GetViewOmissions(host.view, 0, nullptr, nullptr), VOY_ERROR_INVALID_ARGUMENT,
                 "count");
  expect_refused(voy.GetViewOmissions(host.view, 2, nullptr, &count), VOY_ERROR_INVALID_ARGUMENT,
                 "omissions");
  Host other(voy);
  ASSERT_EQ(voy.DestroyScene(other.scene), VOY_SUCCESS);
  EXPECT_EQ(voy.GetViewOmissions(other.view, 0, nullptr, &count), VOY_ERROR_SCENE_DESTROYED);
}

}  // namespace
