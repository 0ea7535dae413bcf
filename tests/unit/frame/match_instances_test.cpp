#include "runtime/frame/match_instances.h"

#include <gtest/gtest.h>

namespace voyager::match_instances_test {
namespace {

TEST(MatchInstances, TheKthOfASceneIsTheKthThatWas) {
  const auto make = [] { return std::make_shared<Scene>(std::pmr::get_default_resource()); };
  const auto a = make(), b = make(), c = make();
  using From = std::vector<size_t>;
  constexpr size_t kNew = kNewInstance;
  EXPECT_EQ(match_instances({}, {}), From{});
  EXPECT_EQ(match_instances({}, {a, b}), (From{kNew, kNew}));
  EXPECT_EQ(match_instances({a, b}, {}), From{});
  EXPECT_EQ(match_instances({a, b, a}, {a, a, b}), (From{0, 2, 1}));
  EXPECT_EQ(match_instances({a, b, a}, {a, a, a, c}), (From{0, 2, kNew, kNew}));
  EXPECT_EQ(match_instances({a, b, a}, {b, a}), (From{1, 0}));
}

}  // namespace
}  // namespace voyager::match_instances_test
