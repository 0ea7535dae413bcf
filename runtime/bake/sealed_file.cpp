#include "runtime/bake/sealed_file.h"

#include "runtime/base/checksum.h"
#include "runtime/base/error.h"

namespace voyager {

void write_sealed(const std::string& path, std::span<const std::byte> bytes) {
  const uint64_t sum = checksum(bytes);
  AtomicFile file(path);
  file.write(bytes);
  file.write(std::as_bytes(std::span(&sum, 1)));
  file.commit_unflushed();
}

std::vector<std::byte> read_sealed(const std::string& path) {
  const auto source = open_file_source(path);
  uint64_t sum = 0;
  if (source->size() < sizeof sum)
    refuse_folder(path, std::to_string(source->size()) + " bytes", "at least 8");
  std::vector<std::byte> bytes(source->size());
  source->read(0, bytes);
  std::memcpy(&sum, bytes.data() + bytes.size() - sizeof sum, sizeof sum);
  bytes.resize(bytes.size() - sizeof sum);
  if (checksum(bytes) != sum)
    refuse_folder(path, "checksum " + std::to_string(checksum(bytes)), std::to_string(sum));
  return bytes;
}

void refuse_folder(const std::string& path, const std::string& found, const std::string& expected) {
  throw Error(ErrorCode::refused_input, path + ": found " + found + ", expected " + expected +
                                            ": the work folder was altered; remove it and bake "
                                            "again");
}

}  // namespace voyager
