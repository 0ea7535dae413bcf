#include "runtime/frame/node_trainer.h"

#include "runtime/base/error.h"

namespace voyager {

std::unique_ptr<NodeTrainer> Backend::create_trainer(const std::shared_ptr<const Scene>&,
                                                     Workers&) {
  throw Error(ErrorCode::unsupported,
              device_name() + ": found no way to optimize nodes, expected a backend that has one");
}

}  // namespace voyager
