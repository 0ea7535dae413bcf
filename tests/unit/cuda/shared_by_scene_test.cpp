// What a scene's views share on a device is made once, and goes with the last of them.
#include "cuda/scene/shared_by_scene.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace voyager::cuda {
namespace shared_by_scene_test {
namespace {

std::shared_ptr<const Scene> new_scene() {
  return std::make_shared<const Scene>(std::pmr::new_delete_resource());
}

class Sharing : public ::testing::Test {
 protected:
  std::shared_ptr<const int> of(const std::shared_ptr<const Scene>& scene) {
    return shared_.of(scene, [&](const Scene&) { return std::make_shared<int>(++made_); });
  }

  SharedByScene<int> shared_;
  int made_ = 0;
};

TEST_F(Sharing, ViewsOfScenesByTurnsShareEachScenes) {
  const auto a = new_scene(), b = new_scene();
  const auto a1 = of(a), b1 = of(b), a2 = of(a), b2 = of(b);
  EXPECT_EQ(a1, a2);
  EXPECT_EQ(b1, b2);
  EXPECT_NE(a1, b1);
  EXPECT_EQ(made_, 2);
}

TEST_F(Sharing, WhatNoViewHoldsIsGone) {
  const auto scene = new_scene();
  auto held = of(scene);
  const std::weak_ptr<const int> watch = held;
  held.reset();
  EXPECT_TRUE(watch.expired());
  EXPECT_EQ(*of(scene), 2);
}

TEST_F(Sharing, ASceneIsNotKept) {
  auto scene = new_scene();
  const std::weak_ptr<const Scene> watch = scene;
  const auto held = of(scene);
  scene.reset();
  EXPECT_TRUE(watch.expired());
}

TEST_F(Sharing, AFailureToMakeIsNotRemembered) {
  const auto scene = new_scene();
  const auto fail = [](const Scene&) -> std::shared_ptr<int> { throw std::runtime_error("none"); };
  EXPECT_THROW(shared_.of(scene, fail), std::runtime_error);
  EXPECT_EQ(*of(scene), 1);
}

}  // namespace
}  // namespace shared_by_scene_test
}  // namespace voyager::cuda
