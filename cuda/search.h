#pragma once
// One view's search of one scene on the device. Frames are launched on a stream of
// its own and nothing waits for the host, but for what says so.
#include <memory>

#include "cuda/buffer.h"
#include "cuda/cut_state.h"
#include "cuda/device.h"
#include "cuda/search_launch.h"
#include "runtime/frame/backend.h"
#include "runtime/select/references.h"

namespace voyager::cuda {

// A stream and the events around a frame's kernels.
class FrameTimer {
 public:
  FrameTimer();
  ~FrameTimer();
  FrameTimer(const FrameTimer&) = delete;
  FrameTimer& operator=(const FrameTimer&) = delete;

  cudaStream_t stream() const { return stream_; }
  void begin();
  void middle();
  void end();
  void wait() const;
  // Waits; milliseconds from begin to middle, and from middle to end.
  SearchTimes times() const;

 private:
  cudaStream_t stream_ = nullptr;
  cudaEvent_t events_[3] = {};
};

// Arrays of a scene that searches share.
std::shared_ptr<const DeviceTree> upload_tree(const Scene& scene);

// streaming, temporal or temporal_visit. Device memory: the scene's arrays, 24 bytes a
// subtree and, for the list, 8 bytes a node.
std::unique_ptr<SceneSearch> create_partitioned_search(std::shared_ptr<const Device> device,
                                                       std::shared_ptr<const DeviceTree> tree,
                                                       std::shared_ptr<const Scene> scene,
                                                       Search kind, bool weights);

// Uploads every node's record and parent for itself: it is a baseline, not what a frame uses.
std::unique_ptr<SceneSearch> create_exhaustive_search(std::shared_ptr<const Device> device,
                                                      std::shared_ptr<const Scene> scene,
                                                      bool weights);

}  // namespace voyager::cuda
