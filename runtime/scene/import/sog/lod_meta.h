#pragma once
// The lod-meta.json of a streamed SOG scene: a tree of boxes, each of whose leaves has some
// Gaussians at several levels, in SOG scenes beside the file.
#include <string>
#include <vector>

#include "runtime/base/file.h"

namespace voyager::sog {

// Gaussians of one of the files.
struct Part {
  std::string file;
  uint64_t first, count;
};

// Of every leaf its finest level, and the environment, which belongs to all levels. Each Gaussian
// once; in the order of the files. Throws Error(refused_input).
std::vector<Part> finest_level(const ByteSource& lod_meta);

}  // namespace voyager::sog
