// Where a bake has its native pixel from.
#include "runtime/bake/native_choice.h"

#include <gtest/gtest.h>

#include "runtime/base/error.h"
#include "tests/support/scene_files.h"
#include "tests/support/test_support.h"

namespace voyager::native_choice_test {
namespace {

constexpr Mat3d kAlongZ{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

TEST(NativeChoice, CamerasDoNotChangeWhatACompensatedFilterSays) {
  GaussianCloud cloud = test::random_cloud(300, 7);
  NativeChoice choice;
  choice.cameras = {{{0, 0, -60}, kAlongZ, 500, 500, 500, 500, 1000, 1000}};
  EXPECT_TRUE(native_scale(choice, cloud).by_cameras);
  cloud.native = compensated_scale(kLowPass);
  const FoundScale found = native_scale(choice, cloud);
  EXPECT_EQ(found.scale, cloud.native);
  EXPECT_FALSE(found.by_cameras);
  choice.cameras[0].position.z = 9000;
  EXPECT_EQ(test::error_code([&] { native_scale(choice, cloud); }), ErrorCode::refused_input);
}

}  // namespace
}  // namespace voyager::native_choice_test
