#include "plugin/byte_source.h"

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
  check_range(*this, offset, into.size());
  if (into.empty()) return;
  const int32_t found = call(source_, offset, into);
  if (found == VOY_SUCCESS) return;
  const bool later = found != VOY_ERROR_FILE_NOT_FOUND && found != VOY_ERROR_REFUSED_INPUT;
  throw Error(later ? ErrorCode::io_transient : ErrorCode::io,
              name_ + ": offset " + std::to_string(offset) + ": reading " +
                  std::to_string(into.size()) + " bytes: found result " + std::to_string(found) +
                  " from the host's read callback, expected VOY_SUCCESS (0)");
}

}  // namespace voyager
