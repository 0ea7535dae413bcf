#pragma once
// What the importers' fuzz targets share: a format must deliver a sound cloud
// or refuse the bytes; anything else is a finding.
#include <cstdlib>

#include "runtime/base/error.h"
#include "runtime/scene/import/importer.h"
#include "runtime/scene/sanitise.h"

namespace voyager {

inline void fuzz_import(GaussianCloud (*import)(ByteReader&, const ImportOptions&),
                        std::span<const std::byte> bytes) {
  const MemorySource source("fuzz", bytes);
  try {
    GaussianCloud cloud = import(*read_source(source), {});
    sanitise(cloud);
    const size_t n = cloud.size(), coefficients = static_cast<size_t>(cloud.coefficients());
    if (cloud.position.size() != 3 * n || cloud.log_scale.size() != 3 * n ||
        cloud.rotation.size() != 4 * n || cloud.sh.size() != 3 * n * coefficients)
      std::abort();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::refused_input) std::abort();
  }
}

}  // namespace voyager
