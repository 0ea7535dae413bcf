#include "runtime/refine/measured.h"

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

}  // namespace

void keep(const Measured& measured, const LodTree& tree, const std::string& path) {
  Packer packer;
  packer.put(kKind).put(mark_of(tree)).put(measured.views);
  packer.put_all(measured.gain).put_all(measured.pictures);
  write_sealed(path, packer.bytes());
}

Measured read_kept(const LodTree& tree, const std::string& path) {
  Measured measured(tree.size());
  if (!std::filesystem::exists(path)) return measured;
  const std::vector<std::byte> bytes = read_sealed(path);
  Unpacker from(path, bytes);
  const auto kind = from.take<uint64_t>(), mark = from.take<uint64_t>();
  if (kind != kKind || mark != mark_of(tree))
    throw Error(ErrorCode::refused_input,
                path +
                    ": found what was measured of another scene, expected this one: remove it, "
                    "and what is measured starts anew");
  measured.views = from.take<uint32_t>();
  from.take_all(measured.gain);
  from.take_all(measured.pictures);
  if (measured.gain.size() != tree.size() || measured.pictures.size() != tree.size())
    refuse_folder(path, std::to_string(measured.gain.size()) + " nodes",
                  std::to_string(tree.size()));
  return measured;
}

}  // namespace voyager
