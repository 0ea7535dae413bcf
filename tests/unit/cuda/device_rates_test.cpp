// Rates from a device's clocks, where the driver tells them.
#include "cuda/device/device_rates.h"

#include <gtest/gtest.h>

namespace voyager::cuda {
namespace device_rates_test {
namespace {

std::optional<int> orin(ClockQuery query) {
  switch (query) {
    case ClockQuery::multiprocessors_khz:
      return 1'300'000;
    case ClockQuery::memory_khz:
      return 3'200'000;
    case ClockQuery::memory_bus_bits:
      return 256;
  }
  return {};
}

TEST(DeviceRates, FollowTheClocks) {
  const DeviceRates rates = rates_of(16, orin);
  EXPECT_DOUBLE_EQ(rates.lane_instructions, 2.6624e12);
  EXPECT_DOUBLE_EQ(rates.bytes, 204.8e9);
}

// On a Jetson the memory's clock is 0, or the query fails.
TEST(DeviceRates, WithoutAMemoryClockTheBytesAreUnknownAndTheRestIsKept) {
  for (const std::optional<int> memory : {std::optional<int>(0), std::optional<int>()}) {
    const DeviceRates rates = rates_of(16, [&](ClockQuery query) {
      return query == ClockQuery::memory_khz ? memory : orin(query);
    });
    EXPECT_DOUBLE_EQ(rates.lane_instructions, 2.6624e12);
    EXPECT_EQ(rates.bytes, 0.0);
  }
}

}  // namespace
}  // namespace device_rates_test
}  // namespace voyager::cuda
