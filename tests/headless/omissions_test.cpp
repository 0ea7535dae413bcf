// What a host is told of a scene's profile and of what a view does without.
#include <cstring>
#include <iterator>

#include "hostile.h"

namespace omissions_test {
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
  EXPECT_GE(profile.minAnisotropy, 1.0f);
  EXPECT_GE(profile.maxAnisotropy, profile.minAnisotropy);
  profile.type = VOY_STRUCTURE_TYPE_FRAME;
  expect_refused(voy.GetSceneInfo(host.scene, &info), VOY_ERROR_INVALID_STRUCTURE, "expected 33");
}

TEST_F(ListedOmissions, AViewListsItsScenesAndItsOwn) {
  Host cpu(voy, device_for(VOY_BACKEND_CPU));
  ASSERT_EQ(cpu.render(), VOY_SUCCESS) << voy.message();
  // Depth was asked for.
  const char* const expected[] = {"tree and search", "SH bands above degree 1", "second eye",
                                  "depth limits", "table of the exponential"};
  uint32_t count = 0;
  ASSERT_EQ(voy.GetViewOmissions(cpu.view, 0, nullptr, &count), VOY_SUCCESS);
  ASSERT_EQ(count, std::size(expected));
  VoyOmission omissions[std::size(expected) + 1] = {};
  EXPECT_EQ(voy.GetViewOmissions(cpu.view, 1, omissions, &count), VOY_INCOMPLETE);
  EXPECT_EQ(omissions[1].what[0], '\0');
  ASSERT_EQ(voy.GetViewOmissions(cpu.view, std::size(omissions), omissions, &count), VOY_SUCCESS);
  for (uint32_t i = 0; i < count; ++i) {
    EXPECT_STREQ(omissions[i].what, expected[i]);
    EXPECT_EQ(omissions[i].type, VOY_STRUCTURE_TYPE_OMISSION);
    EXPECT_EQ(omissions[i].bytes > 0, i != 3) << "limits stay in the host's memory";
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
  ASSERT_EQ(voy.CloseScene(other.scene), VOY_SUCCESS);
  EXPECT_EQ(voy.GetViewOmissions(other.view, 0, nullptr, &count), VOY_ERROR_SCENE_CLOSED);
}

}  // namespace
}  // namespace omissions_test
