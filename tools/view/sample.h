#pragma once
// A few Gaussians of a large flat scene, spread over the file, which stand for all of them until
// the scene is baked.
#include <functional>
#include <memory>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/math/vec.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager::view {

// About `wanted` Gaussians of the flat scene, grown so that they cover what the others leave bare.
// Of a plain .ply only their rows are read; of other formats everything. `checkpoint` is called
// between blocks, and may throw to end the work. Throws as the format's reader does.
GaussianCloud read_sample(const std::shared_ptr<const ByteSource>& source, uint64_t wanted,
                          const std::function<void()>& checkpoint);

// World positions.
std::vector<Vec3d> positions(const GaussianCloud& cloud);

// The bytes of a .ply.
std::vector<std::byte> as_ply(const GaussianCloud& cloud);

}  // namespace voyager::view
