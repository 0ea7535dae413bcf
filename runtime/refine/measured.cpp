#include "runtime/refine/measured.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "runtime/bake/sealed_file.h"
#include "runtime/base/checksum.h"
#include "runtime/base/error.h"

namespace voyager {
namespace {

constexpr uint64_t kKind = 0x31656e69666572;  // "refine1"

uint64_t mark_of(const LodTree& tree) {
  return checksum(std::as_bytes(std::span(tree.records)));
}

[[noreturn]] void refuse(const std::string& path, const std::string& found,
                         const std::string& expected) {
  throw Error(ErrorCode::refused_input, path + ": found " + found + ", expected " + expected +
                                            ": remove it, and what is measured starts anew");
}

// Of a file: what says whose it is, and all before its checksum.
constexpr size_t kHead = 2 * sizeof(uint64_t);
size_t bytes_of(size_t nodes) {
  return kHead + sizeof(uint32_t) + 2 * sizeof(uint64_t) +
         nodes * (sizeof(double) + sizeof(uint32_t));
}

}  // namespace

void keep(const Measured& measured, const LodTree& tree, const std::string& path) {
  Packer packer;
  packer.put(kKind).put(mark_of(tree)).put(measured.views);
  packer.put_all(measured.gain).put_all(measured.pictures);
  write_sealed(path, packer.bytes());
}

void check_kept(const std::string& path) {
  check_kind(path, kKind, "what --refine has measured");
}

Measured read_kept(const LodTree& tree, const std::string& path) {
  Measured measured(tree.size());
  if (!std::filesystem::exists(path)) return measured;
  const auto source = open_file_source(path);
  const size_t expected = bytes_of(tree.size());
  std::vector<std::byte> bytes(
      static_cast<size_t>(std::min<uint64_t>(source->size(), expected + sizeof(uint64_t))));
  source->read(0, bytes);
  uint64_t head[2] = {0, 0};
  if (bytes.size() >= kHead) std::memcpy(head, bytes.data(), kHead);
  if (bytes.size() >= kHead && (head[0] != kKind || head[1] != mark_of(tree)))
    refuse(path, "what was measured of another scene", "this one");
  if (source->size() != expected + sizeof(uint64_t))
    refuse(path, std::to_string(source->size()) + " bytes",
           std::to_string(expected + sizeof(uint64_t)));
  uint64_t sum = 0;
  std::memcpy(&sum, bytes.data() + expected, sizeof sum);
  bytes.resize(expected);
  if (checksum(bytes) != sum)
    refuse(path, "checksum " + std::to_string(checksum(bytes)), std::to_string(sum));
  Unpacker from(path, std::span<const std::byte>(bytes).subspan(kHead));
  measured.views = from.take<uint32_t>();
  from.take_all(measured.gain);
  from.take_all(measured.pictures);
  return measured;
}

}  // namespace voyager
