#include "runtime/optimize/checkpoint.h"

#include <bit>
#include <filesystem>
#include <vector>

#include "runtime/bake/sealed_file.h"
#include "runtime/base/checksum.h"
#include "runtime/base/error.h"

namespace voyager {
namespace {

constexpr uint64_t kKind =
    0x36696d6974706f;  // "optimi6"; a change of the pictures or steps needs another

template <class Values>
uint64_t sum_of(const Values& values) {
  return checksum(std::as_bytes(std::span(values.data(), values.size())));
}

}  // namespace

uint64_t mark_of(const BakedScene& baked, std::span<const TrainingCamera> cameras,
                 const std::string& device) {
  std::vector<uint64_t> parts{sum_of(baked.tree.records),
                              sum_of(baked.node_code),
                              std::bit_cast<uint64_t>(baked.leaves.native.pixel),
                              std::bit_cast<uint64_t>(baked.leaves.native.low_pass),
                              checksum(std::as_bytes(cameras)),
                              sum_of(device)};
  for (const GaussianCloud* cloud : {&baked.leaves, &baked.merged})
    for (const auto* values :
         {&cloud->position, &cloud->log_scale, &cloud->rotation, &cloud->opacity, &cloud->sh})
      parts.push_back(sum_of(*values));
  return sum_of(parts);
}

void write_checkpoint(const Checkpoint& checkpoint, uint64_t mark, const std::string& path) {
  Packer packer;
  const uint64_t head[] = {kKind, mark, checkpoint.pictures, checkpoint.done};
  packer.put(std::span(head));
  packer.put_all(checkpoint.asked);
  packer.put_all(checkpoint.extents).put_all(checkpoint.state.values);
  packer.put_all(checkpoint.state.opacities).put_all(checkpoint.state.first);
  packer.put_all(checkpoint.state.second).put_all(checkpoint.state.steps);
  write_sealed(path, packer.bytes());
}

std::string kept_of_part(const std::string& kept, uint32_t k) {
  return kept + "." + std::to_string(k);
}

std::vector<std::string> kept_files(const std::string& kept) {
  std::vector<std::string> files;
  if (std::filesystem::exists(kept)) files.push_back(kept);
  for (uint32_t k = 0; std::filesystem::exists(kept_of_part(kept, k)); ++k)
    files.push_back(kept_of_part(kept, k));
  return files;
}

void check_checkpoints(const std::string& kept) {
  for (const std::string& path : kept_files(kept))
    check_kind(path, kKind, "what --optimize has learned");
}

bool read_checkpoint(uint64_t mark, const std::string& path, Checkpoint& checkpoint) {
  if (!std::filesystem::exists(path)) return false;
  check_kind(path, kKind, "what --optimize has learned");
  const std::vector<std::byte> bytes = read_sealed(path, "remove it, and learning starts anew");
  Unpacker from(path, bytes);
  uint64_t head[4];
  from.take(std::span<uint64_t>(head));
  if (head[1] != mark)
    throw Error(ErrorCode::refused_input,
                path +
                    ": found what was learned of another scene, by another device, with other "
                    "--training-cameras or another --memory, expected this one: remove it, and "
                    "those of other parts, and learning starts anew");
  checkpoint.pictures = static_cast<uint32_t>(head[2]);
  checkpoint.done = static_cast<uint32_t>(head[3]);
  from.take_all(checkpoint.asked);
  from.take_all(checkpoint.extents);
  from.take_all(checkpoint.state.values);
  from.take_all(checkpoint.state.opacities);
  from.take_all(checkpoint.state.first);
  from.take_all(checkpoint.state.second);
  from.take_all(checkpoint.state.steps);
  return true;
}

}  // namespace voyager
