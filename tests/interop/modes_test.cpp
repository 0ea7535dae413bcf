// Which modes of sharing and synchronising this machine has: those that it lacks are named.
#include <tuple>

#include "frames.h"

namespace modes_test {
namespace {

using Mode = std::tuple<VoyVulkanSharing, VoyVulkanSync>;

class Modes : public Interop, public ::testing::WithParamInterface<Mode> {};

std::string name_of(const ::testing::TestParamInfo<Mode>& mode) {
  const char* syncs[] = {"Auto", "Timeline", "Binary", "Host"};
  const bool device = std::get<0>(mode.param) == VOY_VULKAN_SHARING_DEVICE;
  return std::string(device ? "Device" : "HostMemory") + syncs[std::get<1>(mode.param)];
}
INSTANTIATE_TEST_SUITE_P(Of, Modes,
                         ::testing::Combine(::testing::ValuesIn(kSharings),
                                            ::testing::ValuesIn(kSyncs)),
                         name_of);

TEST_P(Modes, AreHadWhereTheyMustBe) {
  const auto [sharing, sync] = GetParam();
  const bool expected = must_have(sharing, sync);  // makes a device of its own
  const bool had = create(sharing, sync);
  const std::string why = voyGetLastErrorMessage();
  ASSERT_EQ(had, expected) << why;
  if (!had && sharing == VOY_VULKAN_SHARING_HOST) return;  // of no machine
  if (!had) VOYAGER_SKIP_WITHOUT(CUDA, why);
  EXPECT_EQ(found.sharing, sharing);
  EXPECT_EQ(found.sync, sync);
}

}  // namespace
}  // namespace modes_test
