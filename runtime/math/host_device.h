#pragma once
// The only place that knows whether a formula is being compiled for the device.
#if defined(__CUDACC__)
#define VOYAGER_HD __host__ __device__ inline
#elif defined(VOYAGER_ISA)
// A file compiled for one instruction set must not leave out-of-line copies of
// shared functions for the linker to pick on a machine that lacks it.
#define VOYAGER_HD __attribute__((always_inline)) inline
#else
#define VOYAGER_HD inline
#endif

// Before a loop whose arrays a device is to have in registers.
#if defined(__CUDA_ARCH__)
#define VOYAGER_UNROLL _Pragma("unroll")
#else
#define VOYAGER_UNROLL
#endif
