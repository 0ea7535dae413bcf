// A kernel that does not start is told of where it was launched, and not by the next one.
#include <string>

#include "cuda/device/launch.cuh"
#include "cuda/device/stream.h"
#include "runtime/base/error.h"
#include "tests/gpu/device_test.h"

namespace voyager::test {
namespace launch_test {
namespace {

__global__ void nothing() {}

class LaunchTest : public DeviceTest {};

TEST_F(LaunchTest, AKernelThatDoesNotStartIsNamed) {
  const auto on = device();
  on->use();
  const cuda::Stream stream;
  constexpr unsigned kTooMany = 4096;  // threads of a block
  try {
    cuda::launch_kernel("nothing", nothing, {1, kTooMany, stream.get()});
    FAIL() << "it started";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("nothing"), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(cuda::launch_kernel("nothing", nothing, {1, 1, stream.get()}));
  EXPECT_NO_THROW(stream.wait());
}

}  // namespace
}  // namespace launch_test
}  // namespace voyager::test
