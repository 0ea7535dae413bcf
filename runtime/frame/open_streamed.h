#pragma once
#include <optional>

#include "runtime/frame/backend.h"

namespace voyager {

struct StreamingDesc {
  // Bytes, on the device that renders, of the pool, its links, and what views keep; 0: no limit.
  uint64_t budget = 0;
  std::function<void(uint64_t)> count;  // as StreamDesc has it
  unsigned readers = 2;  // threads that read and decode; 0: none, SceneStream::step() does it
  // What is read at once, from the top of the tree, if there are slots: stored bytes.
  uint64_t first_bytes = 32 << 20;
  // A point of the scene; around it so much is read in place of that.
  std::optional<Vec3d> start;
  uint64_t start_bytes = 64 << 20;
  std::function<double()> clock;  // as StreamDesc has it
};

// Opens a .voy file of which a part at a time is in memory; other formats are loaded whole, as
// load_scene() does. Reads the header, the directory and the top of the tree. Throws as
// load_scene() does, and Error(over_budget) where the budget has no room for the top; the message
// names what it takes. The backend outlives the scene.
std::shared_ptr<Scene> open_streamed(const std::shared_ptr<const ByteSource>& source,
                                     const StreamingDesc& desc, Backend& backend,
                                     std::pmr::memory_resource* memory, Workers& workers);

}  // namespace voyager
