#include "runtime/optimize/kept.h"

#include <filesystem>

#include "runtime/bake/sealed_file.h"
#include "runtime/base/checksum.h"
#include "runtime/base/error.h"

namespace voyager {
namespace {

constexpr uint64_t kKind = 0x31696d6974706f;  // "optimi1"

template <class Values>
uint64_t sum_of(const Values& values) {
  return checksum(std::as_bytes(std::span(values.data(), values.size())));
}

}  // namespace

uint64_t mark_of(const BakedScene& baked) {
  const uint64_t parts[] = {sum_of(baked.tree.records), sum_of(baked.merged.position),
                            sum_of(baked.leaves.position), sum_of(baked.leaves.sh)};
  return checksum(std::as_bytes(std::span(parts)));
}

void keep(const Standing& standing, uint64_t mark, const std::string& path) {
  Packer packer;
  const uint64_t head[] = {kKind, mark, standing.steps, standing.done};
  packer.put(std::span(head));
  packer.put_all(standing.extents).put_all(standing.state.values);
  packer.put_all(standing.state.opacities).put_all(standing.state.first);
  packer.put_all(standing.state.second).put_all(standing.state.steps);
  write_sealed(path, packer.bytes());
}

void check_kept_standing(const std::string& path) {
  if (!std::filesystem::exists(path)) return;
  const auto source = open_file_source(path);
  uint64_t kind = 0;
  if (source->size() >= sizeof kind) source->read(0, std::as_writable_bytes(std::span(&kind, 1)));
  if (kind != kKind)
    throw Error(ErrorCode::refused_input,
                path +
                    ": found a file that no bake has written, expected what --optimize has "
                    "learned: give another -o, or move it away");
}

bool read_kept(uint64_t mark, const std::string& path, Standing& standing) {
  if (!std::filesystem::exists(path)) return false;
  check_kept_standing(path);
  const std::vector<std::byte> bytes = read_sealed(path);
  Unpacker from(path, bytes);
  uint64_t head[4];
  from.take(std::span<uint64_t>(head));
  if (head[1] != mark)
    throw Error(ErrorCode::refused_input,
                path +
                    ": found what was learned of another scene, expected this one: remove it, "
                    "and learning starts anew");
  standing.steps = static_cast<uint32_t>(head[2]);
  standing.done = static_cast<uint32_t>(head[3]);
  from.take_all(standing.extents);
  from.take_all(standing.state.values);
  from.take_all(standing.state.opacities);
  from.take_all(standing.state.first);
  from.take_all(standing.state.second);
  from.take_all(standing.state.steps);
  return true;
}

}  // namespace voyager
