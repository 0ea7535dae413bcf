#include <cuda_runtime.h>

#include "tests/gpu/splat_test.h"
#include "tests/support/streaming_flight.h"

namespace voyager::test {
namespace streaming_flight_test {
namespace {

using StreamingFlight = SplatTest;

// What other processes take of the device counts, too.
double all_megabytes() {
  size_t left = 0, all = 0;
  EXPECT_EQ(cudaMemGetInfo(&left, &all), cudaSuccess);
  return host_megabytes() + static_cast<double>(all - left) / 1e6;
}

TEST_F(StreamingFlight, ManyThreadsDrawCutsOnly) {
  fly_streamed(*cuda, all_megabytes);
}

}  // namespace
}  // namespace streaming_flight_test
}  // namespace voyager::test
