#include "runtime/bake/merged.h"

#include <sys/stat.h>

#include <array>

#include "runtime/bake/sealed_file.h"
#include "runtime/bake/work_files.h"

namespace voyager {
namespace {

using Identity = std::array<uint64_t, 5>;

// Zeros of a file that is not there.
Identity identity_of(const std::string& path) {
  struct stat info = {};
  if (::stat(path.c_str(), &info) != 0) return {};
  return {info.st_dev, info.st_ino, static_cast<uint64_t>(info.st_size),
          static_cast<uint64_t>(info.st_mtim.tv_sec), static_cast<uint64_t>(info.st_mtim.tv_nsec)};
}

}  // namespace

void note_merged(const WorkFolder& folder, const std::string& output, const BakeSummary& summary) {
  Packer packer;
  packer.put(identity_of(output));
  packer.put(std::array{summary.gaussians, summary.nodes, summary.subtrees, summary.chunks});
  packer.put(summary.import).put(summary.cells);
  write_sealed(folder.file(kMerged), packer.bytes());
}

std::optional<BakeSummary> read_merged(const WorkFolder& folder, const std::string& output) {
  if (!folder.has(kMerged)) return std::nullopt;
  const std::string path = folder.file(kMerged);
  const std::vector<std::byte> bytes = read_sealed(path);
  Unpacker from(path, bytes);
  const auto identity = from.take<Identity>();
  if (identity == Identity{} || identity != identity_of(output)) return std::nullopt;
  BakeSummary summary;
  const auto counts = from.take<std::array<uint64_t, 4>>();
  summary.gaussians = counts[0], summary.nodes = counts[1];
  summary.subtrees = counts[2], summary.chunks = counts[3];
  summary.import = from.take<ImportReport>();
  summary.cells = from.take<uint32_t>();
  return summary;
}

}  // namespace voyager
