#pragma once
// What a frame has shown of the chunks of streamed scenes, found from its tiles' lists.
#include <cuda_runtime_api.h>

#include "cuda/splat/splats.h"

namespace voyager::cuda {

// An instance that is projected, in the frame's order. nodes: its list's, addresses of a pool whose
// slots have so many; null where nothing is told of it.
struct ShownInstance {
  const uint32_t* nodes;
  uint32_t slot_nodes;
  uint32_t first_slot;  // its slots lie behind those of the instances before it
};

struct ShownFrame {
  SplatView splats;  // of a frame of one pass
  uint32_t width[kMaxEyes], height[kMaxEyes];
  float least_log;  // log α*, in the exponential's base
  float to_base_2;  // what that base's logarithms are times to be those of base 2
  uint32_t count;   // of instances
  ShownInstance instances[kMaxInstances];
  // By slot, 1 where a node is in a tile's list, and where light of 1/255 reaches one: 0 before.
  uint8_t* drawn;
  uint8_t* shown;
};

// shown.cu. Reads the lists, records and counters that the frame's stages have left.
void launch_shown(const ShownFrame& frame, cudaStream_t stream);

}  // namespace voyager::cuda
