#pragma once
// How urgently viewers want each chunk, by its hull alone: whether it is resident, and what it
// hangs from, do not matter.
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/format/layout.h"
#include "runtime/stream/viewer.h"

namespace voyager {

class ChunkLooks {
 public:
  // What a viewer sees, will see soon if it goes on, would see if it turned its head, and the rest.
  enum class Class : uint32_t { around, turned, soon, seen };

  // Orders by class, then by the error where a chunk is missing. The last bit says that it is a
  // chunk's own urgency, and not what another has lent.
  static constexpr uint32_t kOwn = 1;
  static Class class_of(uint32_t urgency) { return static_cast<Class>(urgency >> 30); }
  static float error_of(uint32_t urgency);

  struct Look {
    uint32_t urgency;  // 0: nobody wants it
    bool now;          // a viewer wants it that is not ahead
  };

  explicit ChunkLooks(std::span<const ChunkEntry> chunks)
      : chunks_(chunks), urgency_(chunks.size()), round_(chunks.size()) {}

  // A new round, with these viewers.
  void begin(std::vector<Viewer> viewers);
  // The first call of a round for a chunk looks at all viewers.
  Look at(uint32_t chunk) {
    if (round_[chunk] >> 1 != now_) look(chunk);
    return {urgency_[chunk], (round_[chunk] & 1) != 0};
  }

 private:
  void look(uint32_t chunk);

  std::span<const ChunkEntry> chunks_;
  std::vector<Viewer> viewers_;
  // By chunk: as of the round, whose last bit is Look::now.
  std::vector<uint32_t> urgency_, round_;
  uint32_t now_ = 0;
};

}  // namespace voyager
