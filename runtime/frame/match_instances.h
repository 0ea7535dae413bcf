#pragma once
#include <cstddef>
#include <vector>

#include "runtime/frame/backend.h"

namespace voyager {

inline constexpr size_t kNewInstance = SIZE_MAX;

// Of each instance of `now`, the one of `before` whose state it goes on with: the k-th instance
// of a scene takes that of the k-th instance of this scene. kNewInstance where there is none.
std::vector<size_t> match_instances(const Scenes& before, const Scenes& now);

}  // namespace voyager
