#pragma once
#include <memory>

#include "runtime/base/file.h"

namespace voyager::view {

// A binary .ply with nothing but vertices of a fixed size, seen as a .ply of every `step`-th of
// them: the others are not read. NULL for any other file. Throws as reading the header does.
std::shared_ptr<const ByteSource> sparse_ply(const std::shared_ptr<const ByteSource>& source,
                                             uint64_t step);

}  // namespace voyager::view
