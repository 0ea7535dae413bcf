#pragma once
// From one flat format to another. Memory does not grow with the scene.
#include <functional>
#include <memory>
#include <string>

#include "runtime/base/progress.h"
#include "runtime/base/workers.h"
#include "runtime/scene/export/flat_file.h"
#include "runtime/scene/import/block_reader.h"

namespace voyager {

// Opens the input anew: it is read twice, since writers have to know how many Gaussians are sound,
// and how far they reach, before the first.
using OpenBlocks = std::function<std::unique_ptr<BlockReader>()>;

// Gaussians are sanitised as importers do, and keep their order where the format does. Returns what
// was written. Throws as the reader and the writer do. Progress stages "reading", "writing".
FlatContents convert(const OpenBlocks& open, const std::string& path, const FlatOptions& options,
                     Workers& workers, const Progress& progress);

}  // namespace voyager
