#include "tests/support/streaming_flight.h"

namespace voyager {
namespace {

TEST(StreamingFlight, ManyThreadsDrawCutsOnly) {
  test::fly_streamed(*create_cpu_backend(), test::host_megabytes);
}

}  // namespace
}  // namespace voyager
