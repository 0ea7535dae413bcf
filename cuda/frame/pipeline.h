#pragma once
#include <memory>

#include "cuda/frame/instances.h"
#include "runtime/frame/backend.h"

namespace voyager::cuda {

// A view's frames with our splatting: every stage on one stream, no wait for the host
// before the end, no allocation once the buffers have grown to what the frames need.
std::unique_ptr<Pipeline> create_pipeline(std::shared_ptr<const Device> device, MakeInstance make,
                                          const Scenes& scenes, const PipelineDesc& desc);

}  // namespace voyager::cuda
