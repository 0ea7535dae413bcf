// What one device answers is not another's.
#include "cuda/device/per_device.h"

#include <gtest/gtest.h>

namespace voyager::cuda {
namespace per_device_test {
namespace {

TEST(PerDevice, EachIsAskedOnceAndHasItsOwnAnswer) {
  PerDevice<unsigned> known;
  unsigned asked = 0;
  const auto answer = [&](unsigned of) { return [&asked, of] { return ++asked, of; }; };
  for (int time = 0; time < 2; ++time) {
    EXPECT_EQ(known.of(0, answer(6)), 6u);
    EXPECT_EQ(known.of(1, answer(8)), 8u);
    EXPECT_EQ(known.of(31, answer(4)), 4u);
  }
  EXPECT_EQ(asked, 3u);
}

TEST(PerDevice, MoreDevicesThanAreKeptAreAskedEachTime) {
  PerDevice<unsigned> known;
  for (unsigned time = 1; time <= 3; ++time)
    for (const int device : {32, 1000}) EXPECT_EQ(known.of(device, [&] { return time; }), time);
}

}  // namespace
}  // namespace per_device_test
}  // namespace voyager::cuda
