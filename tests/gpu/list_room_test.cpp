// What a view's list of a streamed scene has room for. Needs no device.
#include <gtest/gtest.h>

#include "cuda/search/search.h"
#include "runtime/frame/scene.h"

namespace voyager::test {
namespace list_room_test {
namespace {

constexpr SlotShape kShape{107, 64};
constexpr PoolRoom kAll{1000, 1, 1};

Scene scene_of(uint32_t leaves, uint32_t top) {
  Scene scene(std::pmr::get_default_resource());
  scene.leaf_count = leaves, scene.node_count = 100000;
  scene.search.tier_begin = {0, top, 20000};
  return scene;
}

uint64_t most(const Scene& scene) {
  return cuda::with_view({1, 1, 1, 1}, scene, kShape).list.nodes(kAll);
}

TEST(ListRoom, IsAsManyNodesAsTheFileHasLeaves) {
  EXPECT_EQ(most(scene_of(70000, 5)), 70000u);
}

// The top is linked whatever the file says.
TEST(ListRoom, HoldsTheTopOfAFileThatClaimsTooFewLeaves) {
  EXPECT_GE(most(scene_of(1, 7)), 7u * kSubtreeNodes);
  EXPECT_EQ(most(scene_of(1, 20000)), 100000u);
}

}  // namespace
}  // namespace list_room_test
}  // namespace voyager::test
