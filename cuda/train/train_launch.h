#pragma once
// The kernels by which merged Gaussians learn (runtime/frame/node_trainer.h), launched on a
// stream. None waits for the host.
#include <cuda_runtime_api.h>

#include "cuda/splat/splat_launch.h"
#include "runtime/frame/node_trainer.h"

namespace voyager::cuda {

// A splat's SplatSums, then the squared error that falls to it: integers, so that no sum depends on
// the order of its terms.
using FixedSum = unsigned long long;
inline constexpr int kSums = 10;
inline constexpr float kFixedOne = 68719476736.0f;  // 2³⁶: 1e-11 to 1e8
inline constexpr float kFixedMost = 67108864.0f;    // 2²⁶: half of what a sum holds

// Of a picture, row by row: colour over black, and 1 - transmittance.
struct TrainPictures {
  const float4* drawn;
  const float4* truth;
  uint32_t width, height;
  float weight;  // of the squared error
};

// train_picture.cu. Means of samples × samples.
void launch_mean(const float4* fine, uint32_t samples, float4* mean, uint32_t width,
                 uint32_t height, cudaStream_t stream);
// Adds the squared error of colours.
void launch_squares(const TrainPictures& pictures, FixedSum* squares, cudaStream_t stream);

// train_blend.cu. frame: the lists of `drawn`. Adds to the sums of the slots, kSums each.
void launch_train_blend(const SplatFrame& frame, const TrainPictures& pictures, float log_threshold,
                        FixedSum* sums);

// A place's gradient: whether it has one, the sign of its parent's rotation, the opacity that was
// drawn, then by number (TrainingState), of what was drawn. Scales as they are, not their
// logarithms; the rotation's at the unit quaternion.
inline constexpr int kGradientHead = 3;
constexpr int gradient_stride(int sh_degree) {
  return kGradientHead + numbers_of(sh_degree);
}

// train_project.cu. Of each place of the frame's list, which are its ranks, from its slot's sums.
void launch_train_project(const SplatFrame& frame, const FixedSum* sums, float* gradients);

// What moves. Rows are merged nodes'; row_of is kNoNode for a leaf.
struct TrainedArrays {
  float4* hulls;
  float4* shapes;
  float* opacities;
  float* coefficients;
  const uint32_t* row_of;
  float* first;
  float* second;
  uint32_t* steps;
  int sh_degree;
};

// train_update.cu. Of the places that have a gradient, and of the parents that they blend with.
void launch_train_update(const SplatFrame& frame, const float* gradients,
                         const TrainedArrays& arrays, const LearningRates& rates);

}  // namespace voyager::cuda
