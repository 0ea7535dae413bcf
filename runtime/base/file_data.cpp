#include "runtime/base/file_data.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>

#include "runtime/base/error.h"
#include "runtime/base/megabytes.h"

namespace voyager {
namespace {

constexpr uint64_t kAlwaysRead = 64'000'000;  // bytes
constexpr uint64_t kLeastShare = 4;           // of the size, a quarter

// Bytes outside holes, counted until they are `enough`. A file in more pieces than are looked at
// has what its blocks hold.
uint64_t data_bytes(int fd, const struct stat& info, uint64_t enough) {
  constexpr int kMostPieces = 4096;
  const uint64_t in_blocks = uint64_t{512} * static_cast<uint64_t>(info.st_blocks);
  uint64_t found = 0;
  off_t end = 0;
  for (int pieces = 0; found < enough; ++pieces) {
    if (pieces == kMostPieces) return std::max(found, in_blocks);
    const off_t begin = ::lseek(fd, end, SEEK_DATA);
    if (begin < 0) return errno == ENXIO ? found : enough;  // ENXIO: no more data
    end = ::lseek(fd, begin, SEEK_HOLE);
    if (end < 0) return enough;
    found += static_cast<uint64_t>(end - begin);
  }
  return found;
}

}  // namespace

void require_data(int fd, const std::string& name) {
  struct stat info = {};
  if (::fstat(fd, &info) != 0 || !S_ISREG(info.st_mode)) return;
  const auto size = static_cast<uint64_t>(info.st_size);
  if (size <= kAlwaysRead) return;
  const off_t position = ::lseek(fd, 0, SEEK_CUR);
  const uint64_t found = data_bytes(fd, info, size / kLeastShare);
  ::lseek(fd, position, SEEK_SET);
  if (found >= size / kLeastShare) return;
  throw Error(ErrorCode::refused_input, name + ": found " + megabytes_text(found) +
                                            " of data in a file of " + megabytes_text(size) +
                                            ", the rest holes, expected at least a quarter");
}

}  // namespace voyager
