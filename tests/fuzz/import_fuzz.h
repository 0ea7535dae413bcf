#pragma once
// What the importers' fuzz targets share: a format must deliver a sound cloud
// or refuse the bytes; anything else is a finding.
#include <cstdlib>
#include <optional>

#include "runtime/base/error.h"
#include "runtime/scene/import/importer.h"
#include "runtime/scene/sanitise.h"
#include "tests/fuzz/memory_limit.h"

namespace voyager::fuzz {

inline bool is_complete(const GaussianCloud& cloud) {
  const size_t n = cloud.size(), coefficients = static_cast<size_t>(cloud.coefficients());
  return cloud.position.size() == 3 * n && cloud.log_scale.size() == 3 * n &&
         cloud.rotation.size() == 4 * n && cloud.sh.size() == 3 * n * coefficients;
}

// The result of `read`, or nothing where it refuses the input.
template <class Read>
std::optional<GaussianCloud> unless_refused(const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::refused_input) std::abort();
    return std::nullopt;
  }
}

inline void import_bytes(GaussianCloud (*import)(ByteReader&, const ImportOptions&),
                         std::span<const std::byte> bytes) {
  const MemoryLimit limit(bytes.size());
  const MemorySource source("fuzz", bytes);
  std::optional<GaussianCloud> cloud =
      unless_refused([&] { return import(*read_source(source), {}); });
  if (!cloud) return;
  if (!is_complete(*cloud)) std::abort();
  sanitise(*cloud);
  if (!is_complete(*cloud)) std::abort();
}

}  // namespace voyager::fuzz
