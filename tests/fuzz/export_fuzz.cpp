// A .voy file whose checksums were made right, exported: what is written can be read again and
// has what the file has, or the file is refused and nothing is written.
#include <cstdlib>
#include <filesystem>

#include "runtime/base/error.h"
#include "runtime/format/export_flat.h"
#include "runtime/format/export_hier.h"
#include "runtime/format/further.h"
#include "runtime/scene/import/importer.h"
#include "tests/fuzz/memory_limit.h"
#include "tests/fuzz/scratch_folder.h"
#include "tests/support/sealed.h"

namespace voyager::fuzz {
namespace {

using test::Bytes;

// False where the file is refused.
template <class Export>
bool written(const std::string& path, const Export& run) {
  std::filesystem::remove(path);
  try {
    run();
    return true;
  } catch (const Error& error) {
    const bool right = error.code() == ErrorCode::refused_input ||
                       error.code() == ErrorCode::damaged_chunk ||
                       error.code() == ErrorCode::unsupported;
    if (!right || std::filesystem::exists(path)) std::abort();
    return false;
  }
}

// In the .hier layout: two counts, 11 + 48 words of a Gaussian, node and box.
uint64_t hier_bytes(const SceneFile& scene) {
  const uint64_t nodes = scene.info().node_count;
  return 8 + (nodes + FurtherReader(scene).gaussians()) * (4 * (11 + 48)) + nodes * (28 + 32);
}

size_t gaussians_in(const std::string& path) {
  const auto source = open_file_source(path);
  return import_ply(*read_source(*source), {}).size();
}

void export_all(const Bytes& bytes) {
  const std::string hier = scratch_file("out.hier"), ply = scratch_file("out.ply");
  const MemoryLimit limit(bytes.size());
  try {
    const SceneFile scene(std::make_shared<MemorySource>("fuzz.voy", bytes));
    if (written(hier, [&] { export_hier(scene, hier); }) &&
        std::filesystem::file_size(hier) != hier_bytes(scene))
      std::abort();
    if (written(ply, [&] { export_leaves(scene, ply); }) &&
        gaussians_in(ply) != scene.info().leaf_count)
      std::abort();
    constexpr uint64_t kMost = 20;
    if (written(ply, [&] { export_extent_cut(scene, kMost, ply); }) && gaussians_in(ply) > kMost)
      std::abort();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::refused_input) std::abort();
  }
}

}  // namespace
}  // namespace voyager::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  voyager::fuzz::export_all(voyager::test::sealed({first, first + size}));
  return 0;
}
