// Any bytes of a .hier: its leaves in blocks and as a whole, or a refusal; and with its own tree a
// sound scene, whose .hier is the same tree when it comes back, to the byte.
#include <cstdint>

#include "runtime/format/export_hier.h"
#include "runtime/format/writer.h"
#include "runtime/lod/kept_tree.h"
#include "runtime/lod/validate.h"
#include "tests/fuzz/import_fuzz.h"
#include "tests/fuzz/scratch_folder.h"

namespace voyager::fuzz {
namespace {

constexpr size_t kMost = 1000;  // nodes: more take long, and say nothing new

std::vector<std::byte> file_bytes(const std::string& path) {
  const auto source = open_file_source(path);
  std::vector<std::byte> bytes(source->size());
  source->read(0, bytes);
  return bytes;
}

// Through a lossless scene.
std::vector<std::byte> hier_of(const BakedScene& scene) {
  static Workers workers(1);
  const Partition partition = partition_tree(scene.tree, kDefaultChunkBytes);
  if (!validate(scene).empty() || !validate(partition, scene.tree).empty()) std::abort();
  const std::string voy = scratch_file("scene.voy"), hier = scratch_file("out.hier");
  write_scene_file(scene, partition, voy, Quality::lossless, workers);
  export_hier(SceneFile(open_file_source(voy)), hier);
  return file_bytes(hier);
}

void keep(std::span<const std::byte> bytes) {
  const MemoryLimit limit(bytes.size());
  std::optional<KeptTree> kept;
  unless_refused([&] {
    kept = read_kept_tree(std::make_shared<MemorySource>("fuzz.hier", bytes));
    return GaussianCloud();
  });
  if (!kept || kept->scene.tree.size() > kMost) return;
  const std::vector<std::byte> out = hier_of(kept->scene);
  const KeptTree again = read_kept_tree(std::make_shared<MemorySource>("fuzz.hier", out));
  if (again.unused != 0 || again.grown != 0 || hier_of(again.scene) != out) std::abort();
}

}  // namespace
}  // namespace voyager::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  voyager::fuzz::import_named("fuzz.hier", bytes);
  voyager::fuzz::keep(bytes);
  return 0;
}
