#pragma once
#include <memory>

#include "runtime/frame/backend.h"

namespace voyager {

// Float64, one pixel at a time, no tiles: the judge of every other backend.
std::unique_ptr<Backend> create_reference_backend();

}  // namespace voyager
