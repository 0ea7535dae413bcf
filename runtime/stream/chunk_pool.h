#pragma once
// Where the chunks of a scene lie that are resident: on the host, or on a device.
#include "runtime/stream/linker.h"

namespace voyager {

class ChunkPool {
 public:
  virtual ~ChunkPool() = default;
  // Slots that no frame reads; several threads at once, each a slot of its own. Throws Error
  // where the pool itself is at fault.
  virtual void fill(uint32_t slot, const StagedChunk& chunk) = 0;
  // Between two frames: what was filled before and is linked now is there for the next one.
  virtual void apply(const LinkPatch& patch) = 0;
  // Room for so many slots instead; what they held is lost, and nothing is linked. No frame
  // reads the pool and no slot is being filled. Throws Error(over_budget) or std::bad_alloc,
  // and may then have any number of slots up to those it had; where there are as many already, a
  // pool may keep its memory, and then throws nothing.
  virtual void resize(uint32_t slots) = 0;
};

}  // namespace voyager
