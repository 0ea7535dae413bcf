#pragma once
#include <memory>

#include "cuda/frame/instances.h"
#include "runtime/frame/backend.h"

namespace voyager::cuda {

// A view's frames with our splatting: every stage on one stream, no wait for the host
// before the end, no allocation once the buffers have grown to what the frames need. workers: hand
// images on; they outlive it.
std::unique_ptr<Pipeline> create_pipeline(std::shared_ptr<const Device> device, MakeInstance make,
                                          const Scenes& scenes, const PipelineDesc& desc,
                                          Workers& workers);

}  // namespace voyager::cuda
