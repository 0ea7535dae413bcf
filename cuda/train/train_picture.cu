// The truth from its samples, and how far a picture is from it.
#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/train/fixed_sum.cuh"
#include "cuda/train/train_launch.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kThreads = 256;

__global__ void __launch_bounds__(kThreads)
    train_mean(const float4* fine, uint32_t samples, float4* mean, uint32_t width,
               uint32_t height) {
  const uint32_t pixel = blockIdx.x * kThreads + threadIdx.x;
  if (pixel >= width * height) return;
  const uint32_t x = pixel % width, y = pixel / width;
  float4 sum{};
  for (uint32_t row = 0; row < samples; ++row) {
    const float4* at = fine + (size_t{y} * samples + row) * width * samples + x * samples;
    for (uint32_t column = 0; column < samples; ++column) {
      const float4 sample = __ldg(at + column);
      sum.x += sample.x, sum.y += sample.y, sum.z += sample.z, sum.w += sample.w;
    }
  }
  const float share = 1.0f / static_cast<float>(samples * samples);
  mean[pixel] = {share * sum.x, share * sum.y, share * sum.z, share * sum.w};
}

__global__ void __launch_bounds__(kThreads)
    train_squares(TrainPictures pictures, FixedSum* squares) {
  float sum = 0;
  const uint32_t pixel = blockIdx.x * kThreads + threadIdx.x;
  if (pixel < pictures.width * pictures.height) sum = squared_error(pictures, pixel);
  sum = warp_sum(sum);
  if (lane_in_warp() == 0 && sum > 0.0f) add_fixed(squares, sum);
}

unsigned blocks_of(uint32_t pixels) {
  return (pixels + kThreads - 1) / kThreads;
}

}  // namespace

void launch_mean(const float4* fine, uint32_t samples, float4* mean, uint32_t width,
                 uint32_t height, cudaStream_t stream) {
  launch_kernel("train_mean", train_mean, {blocks_of(width * height), kThreads, stream}, fine,
                samples, mean, width, height);
}

void launch_squares(const TrainPictures& pictures, FixedSum* squares, cudaStream_t stream) {
  launch_kernel("train_squares", train_squares,
                {blocks_of(pictures.width * pictures.height), kThreads, stream}, pictures, squares);
}

}  // namespace voyager::cuda
