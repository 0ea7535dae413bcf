#pragma once
#include <memory>

#include "cuda/device/device.h"
#include "runtime/base/workers.h"
#include "runtime/frame/node_trainer.h"

namespace voyager::cuda {

// The scene is resident and has a tree. Device memory: the scene's arrays with coefficients in
// binary32, twice the merged nodes' numbers, and what pictures need. Throws Error(over_budget).
std::unique_ptr<NodeTrainer> create_node_trainer(std::shared_ptr<const Device> device,
                                                 std::shared_ptr<const Scene> scene);

}  // namespace voyager::cuda
