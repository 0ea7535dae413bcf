// What the last message and the log say where something gets in between.
#include "host.h"

namespace messages_test {
namespace {

// What a log was told of a call, before and after a call of its own that fails.
struct FailingLog {
  static void VOY_CALL write(void* user, VoyLogLevel level, const char* message) {
    auto& log = *static_cast<FailingLog*>(user);
    if (level != VOY_LOG_LEVEL_ERROR) return;
    log.before = message;
    VoyFrustum frustum = {};
    EXPECT_EQ(log.voy.FrustumFromAngles(9, 9, 9, 9, &frustum), VOY_ERROR_INVALID_ARGUMENT);
    log.after = message;
    log.own = log.voy.message();
  }

  const Library& voy;
  std::string before, after, own;
};

TEST(Messages, ALogWhoseOwnCallFailsChangesNoMessage) {
  const Library voy;
  FailingLog log{voy, {}, {}, {}};
  VoyDeviceDesc desc = device_for(VOY_BACKEND_CPU);
  desc.log = FailingLog::write;
  desc.logUser = &log;
  Host host(voy, desc);
  VoySceneDesc scene_desc = VOY_SCENE_DESC_INIT;
  scene_desc.path = "/no/such/file";
  VoyScene scene = nullptr;
  ASSERT_EQ(voy.OpenScene(host.device, &scene_desc, &scene), VOY_ERROR_FILE_NOT_FOUND);
  EXPECT_NE(log.before.find("/no/such/file"), std::string::npos) << log.before;
  EXPECT_EQ(log.after, log.before) << "the header: valid during the call";
  EXPECT_NE(log.own.find("voyFrustumFromAngles"), std::string::npos) << log.own;
  EXPECT_EQ(voy.message(), log.before);
}

// Wherever in a character of three bytes the room ends.
TEST(Messages, OneThatIsTooLongEndsWithAWholeCharacter) {
  const Library voy;
  Host host(voy, device_for(VOY_BACKEND_CPU));
  for (size_t before = 0; before < 3; ++before) {
    std::string path(before, 'a');
    for (int i = 0; i < 1000; ++i) path += "\u2030";
    VoySceneDesc desc = VOY_SCENE_DESC_INIT;
    desc.path = path.c_str();
    VoyScene scene = nullptr;
    ASSERT_LT(voy.OpenScene(host.device, &desc, &scene), 0);
    const std::string found = voy.message();
    EXPECT_LE(found.size(), 2047u);
    EXPECT_GE(found.size(), 2045u);
    ASSERT_GE(found.size(), 3u);
    EXPECT_EQ(found.substr(found.size() - 3), "\u2030") << before;
  }
}

}  // namespace
}  // namespace messages_test
