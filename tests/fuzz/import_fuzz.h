#pragma once
// What the importers' fuzz targets share: a format must deliver a sound cloud
// or refuse the bytes; anything else is a finding.
#include <cstdlib>
#include <optional>

#include "runtime/base/error.h"
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/importer.h"
#include "runtime/scene/sanitise.h"
#include "tests/fuzz/memory_limit.h"

namespace voyager::fuzz {

inline bool is_complete(const GaussianCloud& cloud) {
  const size_t n = cloud.size(), coefficients = static_cast<size_t>(cloud.coefficients());
  return cloud.position.size() == 3 * n && cloud.log_scale.size() == 3 * n &&
         cloud.rotation.size() == 4 * n && cloud.sh.size() == 3 * n * coefficients;
}

// The result of `read`, or nothing where it refuses the input, or a file beside it is missing.
template <class Read>
std::optional<GaussianCloud> unless_refused(const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    const bool is_refused =
        error.code() == ErrorCode::refused_input || error.code() == ErrorCode::file_not_found;
    if (!is_refused) std::abort();
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

// What is read in small blocks is complete, and as many as were announced.
inline void read_small_blocks(BlockReader& reader) {
  uint64_t read = 0;
  for (RawBlock block = reader.next(3); block.count > 0; block = reader.next(3)) {
    const GaussianCloud cloud = reader.decode(block);
    if (block.count > 3 || cloud.size() != block.count || !is_complete(cloud)) std::abort();
    read += block.count;
  }
  if (read != reader.count()) std::abort();
}

// The same of a format that is told by its name, as a whole and in blocks.
inline void import_named(const char* name, std::span<const std::byte> bytes) {
  const MemoryLimit limit(bytes.size());
  const auto source = std::make_shared<MemorySource>(name, bytes);
  const auto whole = unless_refused([&] { return import_gaussians(source); });
  if (whole && !is_complete(*whole)) std::abort();
  unless_refused([&] {
    read_small_blocks(*open_blocks(source));
    return GaussianCloud();
  });
}

}  // namespace voyager::fuzz
