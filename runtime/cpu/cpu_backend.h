#pragma once
#include <memory>

#include "runtime/frame/backend.h"

namespace voyager {

std::unique_ptr<Backend> create_cpu_backend();

}  // namespace voyager
