#pragma once
// Where the bakes of flat scenes are kept: voyager/ in $XDG_CACHE_HOME, or in ~/.cache.
#include <cstdint>
#include <string>

#include "runtime/base/file.h"

namespace voyager::view {

inline constexpr uint64_t kLargestCache = 20'000'000'000;  // bytes

// All but work_folder() throw Error(io) where neither XDG_CACHE_HOME nor HOME is set.

// The .voy of a flat scene, whether it is there or not: another one when the scene changes, which
// its size and time of change tell, or when the version of .voy files does.
std::string cached_bake(const std::string& scene, const ByteSource& source);

// Throws Error(io) where it cannot.
void make_cache_folder();

// Where a bake that becomes this file works.
std::string work_folder(const std::string& bake);

// Removes what bakes that were killed have left, and the .voy files that were used least recently,
// until the folder is within the largest size; never `used`, which counts as used now. What cannot
// be removed stays.
void trim_cache(const std::string& used);

}  // namespace voyager::view
