#pragma once
// The chunks of a streamed scene in the host's memory: the scene's own arrays, by address.
#include "runtime/frame/backend.h"

namespace voyager {

RoomBytes host_room_bytes(const Scene& scene, SlotShape shape);

// Makes room in the scene's arrays, for its memory resource to hold to a budget. The scene
// outlives the pool.
std::unique_ptr<ChunkPool> create_host_pool(Scene& scene,
                                            const std::shared_ptr<const SceneFile>& file,
                                            SlotShape shape, PoolRoom room);

}  // namespace voyager
