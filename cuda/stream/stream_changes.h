#pragma once
// What linking has changed in a streamed scene, on its way to one view's search. Also the ids of
// nodes by their addresses, as they were when the view last followed.
#include <optional>

#include "cuda/device/mapped_memory.h"
#include "cuda/device/stream.h"
#include "cuda/search/search_launch.h"
#include "cuda/stream/device_pool.h"
#include "runtime/stream/scene_stream.h"

namespace voyager::cuda {

class StreamChanges {
 public:
  StreamChanges();

  // Since the last call, under SceneStream::hold(). None where that is not known, is too much, or
  // frames that were told before have not ended: the search then starts from nothing. The device
  // reads it until it has passed what read_by() says. pool: the stream's.
  std::optional<Relinked> follow(const SceneStream& stream, const DevicePool& pool);
  void read_by(cudaStream_t stream) const { read_[next_].record(stream); }
  // Of an address in the cut that was found since follow().
  uint32_t id(uint32_t node) const { return slots_[node / slot_nodes_].id(node % slot_nodes_); }

 private:
  std::optional<Relinked> copy();

  static constexpr size_t kPieces = 4;
  // In a piece. After a turn of the head some 700 chunks come and 700 go in a frame, which changes
  // 30,000 subtrees (60,000 at half the frame rate).
  static constexpr size_t kSubtrees = size_t{1} << 16;

  uint64_t version_ = 0;
  std::vector<SlotIds> slots_;
  uint32_t slot_nodes_ = 1;
  std::vector<std::shared_ptr<const StreamChange>> changes_;
  MappedMemory memory_;
  Event read_[kPieces];
  size_t next_ = 0;
};

}  // namespace voyager::cuda
