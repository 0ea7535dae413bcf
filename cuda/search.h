#pragma once
// One view's search of one scene on the device. Frames are launched on a stream of
// its own and nothing waits for the host, but for what says so.
#include <memory>

#include "cuda/device.h"
#include "cuda/device_tree.h"
#include "runtime/frame/scene.h"
#include "runtime/frame/scene_search.h"

namespace voyager::cuda {

// Arrays of a scene that searches share.
std::shared_ptr<const DeviceTree> upload_tree(const Scene& scene);

// streaming, temporal or temporal_visit. Device memory besides the scene's arrays:
// 24 bytes a subtree and, for the list, 4.5 bytes a leaf, with weights 18.
std::unique_ptr<SceneSearch> create_partitioned_search(std::shared_ptr<const Device> device,
                                                       std::shared_ptr<const DeviceTree> tree,
                                                       std::shared_ptr<const Scene> scene,
                                                       Search kind, bool weights);

// Uploads every node's record and parent for itself: it is a baseline, not what a frame uses.
std::unique_ptr<SceneSearch> create_exhaustive_search(std::shared_ptr<const Device> device,
                                                      std::shared_ptr<const Scene> scene,
                                                      bool weights);

}  // namespace voyager::cuda
