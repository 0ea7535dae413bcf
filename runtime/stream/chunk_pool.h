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
};

}  // namespace voyager
