#include "plugin/byte_source.h"

#include <algorithm>

#include "plugin/structs.h"
#include "runtime/base/error.h"

namespace voyager {
namespace {

// What the callback returned; a host in C++ may throw where C would return.
int32_t call(const VoyByteSource& source, uint64_t offset, std::span<std::byte> into) {
  try {
    return number(source.read(source.user, offset, into.size(), into.data()));
  } catch (...) {
    return VOY_ERROR_IO;
  }
}

}  // namespace

void HostSource::read(uint64_t offset, std::span<std::byte> into) const {
  if (offset > source_.size || into.size() > source_.size - offset)
    throw Error(ErrorCode::refused_input,
                name_ + ": offset " + std::to_string(offset) + ": found " +
                    std::to_string(source_.size - std::min(offset, source_.size)) +
                    " bytes, expected " + std::to_string(into.size()));
  if (into.empty()) return;
  const int32_t found = call(source_, offset, into);
  if (found == VOY_SUCCESS) return;
  throw Error(ErrorCode::io, name_ + ": offset " + std::to_string(offset) + ": reading " +
                                 std::to_string(into.size()) + " bytes: found result " +
                                 std::to_string(found) + " of the host's read, expected 0");
}

}  // namespace voyager
