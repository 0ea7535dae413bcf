#pragma once
// Splatting as 3DGS does it, for measurements (METHOD §4, §7): boxes of 3σ, one 64-bit
// (tile, depth) key a pair, expf, one pixel a thread. As there, the host waits for counts
// in the middle of a frame.
#include <memory>

#include "cuda/frame/instances.h"

namespace voyager::cuda {

// Throws Error(unsupported) for an exponential other than exact.
std::unique_ptr<Pipeline> create_baseline_pipeline(std::shared_ptr<const Device> device,
                                                   MakeInstance make, const Scenes& scenes,
                                                   const PipelineDesc& desc, Workers& workers);

}  // namespace voyager::cuda
