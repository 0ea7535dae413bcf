#pragma once
// How much room there is in a scene's budget, which holds for the pool, what links its chunks, and
// what the views that read it keep.
#include <algorithm>

#include "runtime/stream/chunk_pool.h"
#include "runtime/stream/record_room.h"

namespace voyager {

struct RoomBytes {
  PoolBytes pool;  // with what links its chunks, where that lies in the same memory
  PoolBytes view;  // what each instance in a view keeps
  // Where that has room for a cut: nodes of it for each slot, and beside them. 0: any cut.
  uint64_t cut_slot = 0, cut_fixed = 0;

  // A scene without views has room for one.
  uint64_t of(PoolRoom room, size_t views = 1) const {
    return pool.of(room) + std::max<size_t>(views, 1) * view.of(room);
  }
  uint64_t cut_nodes(PoolRoom room) const {
    return cut_slot == 0 ? UINT64_MAX : room.slots * cut_slot + cut_fixed;
  }
};

// The most that fits beside so many views; budget 0: no limit. Throws Error(over_budget) where
// there is no room for the top of the tree; the message names what that takes.
PoolRoom fit_room(const SceneFile& file, const RecordRoom& records, const RoomBytes& bytes,
                  uint64_t budget, size_t views);

}  // namespace voyager
