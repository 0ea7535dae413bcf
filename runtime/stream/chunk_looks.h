#pragma once
// How urgently viewers want each chunk, by its hull alone: whether it is resident, and what it
// hangs from, do not matter.
#include <cstdint>
#include <vector>

#include "runtime/format/chunk_directory.h"
#include "runtime/stream/sparse_array.h"
#include "runtime/stream/viewer.h"

namespace voyager {

class ChunkLooks {
 public:
  // What a viewer sees, will see soon if it goes on, would see if it turned its head, and the rest.
  enum class Class : uint32_t { around, turned, soon, seen };

  // Orders by class, then by the error where a chunk is missing. The last bit says that it is a
  // chunk's own urgency, and not what another has lent.
  static constexpr uint32_t kOwn = 1;
  static constexpr uint32_t kClassAt = 30;
  static Class class_of(uint32_t urgency) { return static_cast<Class>(urgency >> kClassAt); }
  // None of the class is less urgent.
  static constexpr uint32_t least_of(Class of) { return static_cast<uint32_t>(of) << kClassAt; }
  static float error_of(uint32_t urgency);

  struct Look {
    uint32_t urgency;  // 0: nobody wants it
    bool now;          // a viewer wants it that is not ahead
  };

  // The directory outlives it.
  explicit ChunkLooks(const ChunkDirectory& chunks) : chunks_(&chunks), looks_(chunks.size()) {}

  // A new round, with these viewers.
  void begin(std::vector<Viewer> viewers);
  // The first call of a round for a chunk looks at all viewers.
  Look at(uint32_t chunk) {
    uint32_t own = looks_[chunk];
    if (own == kNotLooked) {
      own = look(chunk);
      looked_.push_back(chunk);  // first: what is not in it is never cleared
      looks_.set(chunk, own);
    }
    return own == kNobody ? Look{0, false} : Look{own | kOwn, (own & kNow) != 0};
  }

 private:
  // In the place of kOwn, which an urgency always has here.
  static constexpr uint32_t kNow = kOwn;
  static constexpr uint32_t kNotLooked = 0, kNobody = 1;  // no chunk's: an error is at least 1

  uint32_t look(uint32_t chunk) const;

  const ChunkDirectory* chunks_;
  std::vector<Viewer> viewers_;
  SparseArray<uint32_t> looks_;   // by chunk, of the round
  std::vector<uint32_t> looked_;  // chunks, in it
};

}  // namespace voyager
