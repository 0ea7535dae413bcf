#include <gtest/gtest.h>

#include "tests/support/test_support.h"
#include "tools/camera_writer.h"
#include "tools/view/camera_path.h"
#include "tools/view/navigator.h"

namespace voyager::view_moving_test {
namespace {

using namespace voyager::view;

// Ten metres before the origin of a scene with y down, looking along z.
tools::Camera camera_at(double x) {
  return tools::looking({x, -1, -10}, {1, 0, 0}, {0, 0, 1}, 640, 480, 500);
}

Navigator navigator(Navigation mode) {
  Navigator made;
  made.look_from(camera_at(0), 10);
  made.set_mode(mode);
  made.set_speed(2);
  return made;
}

double distance(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::length(a - b);
}

TEST(ViewMoving, SpeedIsInMetresASecond) {
  for (const Navigation mode : {Navigation::orbit, Navigation::fly, Navigation::walk}) {
    Navigator moving = navigator(mode);
    const glm::dvec3 before = moving.position();
    moving.move({0, 0, -1}, 3);
    EXPECT_NEAR(distance(moving.position(), before), 6, 1e-9);
  }
}

TEST(ViewMoving, OrbitKeepsTheDistanceToItsPoint) {
  Navigator moving = navigator(Navigation::orbit);
  const glm::dvec3 point(0, -1, 0);
  for (int i = 0; i < 20; ++i) {
    moving.turn({0.3, 0.02 * i});
    EXPECT_NEAR(distance(moving.position(), point), 10, 1e-9);
  }
  moving.zoom(1);
  EXPECT_NEAR(distance(moving.position(), point), 9, 1e-9);
}

TEST(ViewMoving, FlyingTurnsOnTheSpotAndWalkingKeepsItsHeight) {
  Navigator flying = navigator(Navigation::fly), walking = navigator(Navigation::walk);
  const glm::dvec3 before = flying.position();
  flying.turn({1, -0.5});
  EXPECT_EQ(distance(flying.position(), before), 0);
  flying.move({0, 0, -1}, 1);
  EXPECT_GT(flying.position().y, before.y + 0.5);  // y is down
  walking.turn({1, -0.5});
  walking.move({0, 0, -1}, 1);
  EXPECT_NEAR(walking.position().y, before.y, 1e-9);
}

TEST(ViewMoving, WalkingBeginsAtAWalkingSpeed) {
  Navigator moving = navigator(Navigation::fly);
  moving.set_speed(50);
  moving.set_mode(Navigation::walk);
  EXPECT_EQ(moving.speed(), kWalkingSpeed);
  moving.set_speed(3);
  moving.set_mode(Navigation::walk);
  EXPECT_EQ(moving.speed(), 3);
}

TEST(ViewMoving, SavedCamerasAreReadBack) {
  const test::TempFolder folder;
  Navigator moving = navigator(Navigation::fly);
  moving.turn({0.7, 0.3});
  const tools::Camera saved[] = {file_camera(moving.camera(640, 480)), camera_at(5)};
  tools::write_cameras(folder.file("cameras.json"), saved);
  const auto read = tools::read_cameras(folder.file("cameras.json"));
  ASSERT_EQ(read.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(read[i].pose.position[axis], saved[i].pose.position[axis]);
    double same = 0;  // of two unit quaternions, whatever their signs
    for (int k = 0; k < 4; ++k) same += read[i].pose.orientation[k] * saved[i].pose.orientation[k];
    EXPECT_NEAR(std::abs(same), 1, 1e-12);
    EXPECT_EQ(read[i].fx, saved[i].fx);
    EXPECT_EQ(read[i].cy, saved[i].cy);
  }
}

TEST(ViewMoving, APathGoesThroughItsBookmarksWithoutAJump) {
  const tools::Camera bookmarks[] = {camera_at(0), camera_at(4), camera_at(5)};
  const auto path = path_through(bookmarks, 101);
  ASSERT_EQ(path.size(), 101u);
  EXPECT_NEAR(path[0].pose.position[0], 0, 1e-9);
  EXPECT_NEAR(path[50].pose.position[0], 4, 1e-9);
  EXPECT_NEAR(path[100].pose.position[0], 5, 1e-9);
  for (size_t i = 1; i < path.size(); ++i)
    EXPECT_LT(std::abs(path[i].pose.position[0] - path[i - 1].pose.position[0]), 0.2);
  EXPECT_EQ(path_through(std::span(bookmarks, 1), 2).size(), 2u);
}

}  // namespace
}  // namespace voyager::view_moving_test
