// Quotients that share a reciprocal are a device's own, for each mantissa of a divisor.
#include "cuda/device/buffer.h"
#include "cuda/device/launch.cuh"
#include "cuda/device/stream.h"
#include "runtime/math/exact.h"
#include "tests/gpu/device_test.h"

namespace voyager::test {
namespace quotient_test {
namespace {

constexpr uint32_t kMantissas = 1u << 23;
constexpr unsigned kThreads = 256;

__device__ bool differ(const Divisor& divisor, float a, float b) {
  return __float_as_uint(divisor.quotient(a).value) != __float_as_uint(__fdiv_rn(a, b));
}

// By numbers beside the divisor, beside 1, and some that have nothing to do with it.
__global__ void count_differences(int exponent, uint32_t* differences) {
  const uint32_t mantissa = blockIdx.x * kThreads + threadIdx.x;
  const float b = __uint_as_float(static_cast<uint32_t>(127 + exponent) << 23 | mantissa);
  const Divisor divisor{b};
  uint32_t count = 0;
  for (int ulps = -3; ulps <= 3; ++ulps) {
    count += differ(divisor, __uint_as_float(__float_as_uint(b) + ulps), b);
    count += differ(divisor, __uint_as_float(__float_as_uint(1.0f) + ulps), b);
  }
  for (uint32_t i = 1; i <= 16; ++i) {
    const uint32_t other = (mantissa * 2654435761u + i * 40503u) % kMantissas;
    count += differ(divisor, __uint_as_float(127u << 23 | other), b);
  }
  if (count != 0) atomicAdd(differences, count);
}

class Quotient : public DeviceTest {};

TEST_F(Quotient, BySharedReciprocalsAreTheRoundedOnes) {
  const auto on = device();
  on->use();
  const cuda::Stream stream;
  const uint32_t none = 0;
  for (const int exponent : {-60, -1, 0, 1, 60}) {
    const cuda::Buffer<uint32_t> differences = cuda::upload(std::span<const uint32_t>(&none, 1));
    cuda::launch_kernel("count_differences", count_differences,
                        {kMantissas / kThreads, kThreads, stream.get()}, exponent,
                        differences.data());
    stream.wait();
    uint32_t found = 0;
    cuda::check(cudaMemcpy(&found, differences.data(), sizeof found, cudaMemcpyDeviceToHost),
                "differences");
    EXPECT_EQ(found, 0u) << "divisors of 2^" << exponent;
  }
}

}  // namespace
}  // namespace quotient_test
}  // namespace voyager::test
