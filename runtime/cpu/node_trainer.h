#pragma once
#include <memory>

#include "runtime/base/workers.h"
#include "runtime/frame/node_trainer.h"

namespace voyager {

// The truth's samples are drawn by the CPU backend. The workers outlive it.
std::unique_ptr<NodeTrainer> create_host_trainer(std::shared_ptr<const Scene> scene,
                                                 Backend& backend, Workers& workers);

}  // namespace voyager
