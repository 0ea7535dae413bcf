#include "tests/support/streaming_flight.h"

namespace voyager::streaming_flight_test {
namespace {

TEST(StreamingFlight, ManyThreadsDrawCutsOnly) {
  test::fly_streamed(*create_cpu_backend(), test::host_megabytes);
}

}  // namespace
}  // namespace voyager::streaming_flight_test
