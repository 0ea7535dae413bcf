#include "runtime/bake/sealed_file.h"

#include <filesystem>

#include "runtime/base/checksum.h"
#include "runtime/base/error.h"

namespace voyager {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& found,
                         const std::string& expected, const char* advice) {
  throw Error(ErrorCode::refused_input,
              path + ": found " + found + ", expected " + expected + ": " + advice);
}

}  // namespace

void write_sealed(const std::string& path, std::span<const std::byte> bytes) {
  const uint64_t sum = checksum(bytes);
  AtomicFile file(path);
  file.write(bytes);
  file.write(std::as_bytes(std::span(&sum, 1)));
  file.commit_unflushed();
}

std::vector<std::byte> read_sealed(const std::string& path, const char* advice) {
  const auto source = open_file_source(path);
  uint64_t sum = 0;
  if (source->size() < sizeof sum)
    refuse(path, std::to_string(source->size()) + " bytes", "at least 8", advice);
  std::vector<std::byte> bytes(source->size());
  source->read(0, bytes);
  std::memcpy(&sum, bytes.data() + bytes.size() - sizeof sum, sizeof sum);
  bytes.resize(bytes.size() - sizeof sum);
  if (checksum(bytes) != sum)
    refuse(path, "checksum " + std::to_string(checksum(bytes)), std::to_string(sum), advice);
  return bytes;
}

void check_kind(const std::string& path, uint64_t kind, const std::string& content) {
  if (!std::filesystem::exists(path)) return;
  const auto source = open_file_source(path);
  uint64_t found = 0;
  if (source->size() >= sizeof found) source->read(0, std::as_writable_bytes(std::span(&found, 1)));
  if (found == kind) return;
  constexpr uint64_t kName = 0xffffffffffff;  // six letters; the version follows
  if ((found & kName) == (kind & kName))
    refuse(path, content + " by another version", "this version's", "remove it to begin anew");
  refuse(path, "a file that no bake has written", content, "give another -o, or move it away");
}

void refuse_folder(const std::string& path, const std::string& found, const std::string& expected) {
  refuse(path, found, expected, kFolderAltered);
}

}  // namespace voyager
