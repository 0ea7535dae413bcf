// Bakes that hold the whole tree at once.
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <span>

#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "runtime/base/open_source.h"
#include "runtime/base/output_path.h"
#include "runtime/base/url.h"
#include "runtime/format/reader.h"
#include "runtime/format/writer.h"
#include "runtime/lod/kept_tree.h"
#include "runtime/lod/validate.h"
#include "runtime/optimize/checkpoint.h"
#include "runtime/refine/refine.h"
#include "runtime/scene/append.h"
#include "runtime/scene/import/importer.h"
#include "tools/commands/bake_arguments.h"
#include "tools/commands/measured_backend.h"
#include "tools/console.h"

namespace voyager::tools {
namespace {

// An input that is moved is read through its reader, and so is one that cannot be opened again.
GaussianCloud read_one(const BakeArguments& arguments, size_t i, BlockReader& reader,
                       const Progress& progress) {
  ImportOptions options;
  options.progress = progress;
  const std::string& path = arguments.inputs[i];
  if (path == "-" || arguments.placement.given()) return import_gaussians(reader, options);
  return import_gaussians(open_source(path), options);
}

// And where each input ends.
std::pair<GaussianCloud, std::vector<uint32_t>> read_all(const BakeArguments& arguments,
                                                         const Readers& readers,
                                                         const Progress& progress) {
  GaussianCloud cloud = read_one(arguments, 0, *readers.front(), progress);
  std::vector<uint32_t> ends{static_cast<uint32_t>(cloud.size())};
  for (size_t i = 1; i < arguments.inputs.size(); ++i) {
    append(cloud, read_one(arguments, i, *readers[i], progress), shown_path(arguments.inputs[i]));
    ends.push_back(static_cast<uint32_t>(cloud.size()));
  }
  return {std::move(cloud), std::move(ends)};
}

void require_sound(const std::string& path, const std::vector<std::string>& findings) {
  if (findings.empty()) return;
  for (const std::string& finding : findings)
    std::fputs(fmt::format("{}: {}\n", path, finding).c_str(), stderr);
  throw Error(ErrorCode::internal,
              fmt::format("{}: the tree broke {} invariants", path, findings.size()));
}

template <class A, class B>
bool same_bytes(const A& a, const B& b) {
  return std::ranges::equal(std::as_bytes(std::span(a)), std::as_bytes(std::span(b)));
}

// Reads back what was written: every chunk is whole, and its subtrees and their nodes
// are those of the partition and the tree.
void verify_file(const std::string& path, const LodTree& tree, const Partition& partition) {
  const SceneFile file(open_file_source(path));
  for (uint32_t i = 0; i < file.info().chunk_count; ++i) {
    const Chunk chunk = file.read_chunk(i);
    const auto written =
        std::span(partition.subtrees).subspan(chunk.first_subtree, chunk.subtrees.size());
    std::vector<NodeRecord> records;
    for (const Subtree& subtree : written)
      for (uint32_t slot = 0; slot < subtree.node_count(); ++slot)
        records.push_back(tree.records[subtree.node(slot)]);
    if (!same_bytes(chunk.subtrees, written) || !same_bytes(chunk.records, records))
      throw Error(ErrorCode::io,
                  fmt::format("{}: chunk {}: found other nodes than were written", path, i));
  }
}

BakeSummary write_baked(const BakeArguments& arguments, const BakedScene& baked, Workers& workers,
                        const Progress& progress) {
  if (arguments.verify) {
    progress("verifying", 0, 0);
    require_sound(arguments.output, validate(baked));
  }
  const Partition partition = partition_tree(baked.tree, arguments.chunk_bytes);
  if (arguments.verify) require_sound(arguments.output, validate(partition, baked.tree));
  write_scene_file(baked, partition, arguments.output, arguments.quality, workers, progress);
  if (arguments.verify) {
    progress("verifying", 0, 0);
    verify_file(arguments.output, baked.tree, partition);
    progress("verifying", 1, 1);
  }
  BakeSummary summary;
  summary.gaussians = baked.leaves.size();
  summary.nodes = baked.tree.size();
  summary.subtrees = partition.subtrees.size();
  summary.chunks = partition.chunk_count();
  summary.import = baked.leaves.report;
  return summary;
}

// As of any cloud; what looks at Gaussians expects logits.
void set_native_scale(const NativeChoice& native, BakedScene& baked) {
  std::pmr::vector<float> linear = baked.leaves.opacity;
  for (float& opacity : baked.leaves.opacity) opacity = flat_logit(opacity);
  baked.leaves.native = baked.merged.native = native_scale(native, baked.leaves).scale;
  baked.leaves.opacity = std::move(linear);
}

}  // namespace

std::string refine_file(const BakeArguments& arguments) {
  return arguments.output + ".refine";
}

std::string optimize_file(const BakeArguments& arguments) {
  return arguments.output + ".optimize";
}

BakeSummary bake_in_memory(const BakeArguments& arguments, const NativeChoice& native,
                           const Readers& readers, const Progress& progress) {
  Workers workers;
  auto [cloud, ends] = read_all(arguments, readers, progress);
  const FoundScale found = native_scale(native, cloud, ends);
  const std::vector<uint8_t> levels = levels_of(found.inputs);
  cloud.native = found.scale;
  if (found.by_cameras) describe(*found.by_cameras);
  BakedScene baked = build_tree(std::move(cloud), workers, progress, {.kind = arguments.tree},
                                {native.cameras, found.unseen_level(), levels});
  const std::string kept = refine_file(arguments);
  if (arguments.refine != 0) refine_extents(baked, arguments.refine, kept, workers, progress);
  const std::string learned = optimize_file(arguments);
  if (arguments.optimize.wanted()) {
    const std::unique_ptr<Backend> backend = create_backend(arguments.optimize.backend);
    OptimizeGoal goal = arguments.optimize.goal(baked.merged.size());
    const uint64_t taken = bytes_to_bake(baked.leaves.size(), baked.leaves.sh_degree) +
                           (arguments.refine != 0 ? bytes_to_refine(baked.leaves.size()) : 0);
    goal.memory = std::max(arguments.memory * 1'000'000, taken + 1) - taken;
    goal.cameras = native.cameras;
    print_learned(optimize_nodes(baked, goal, *backend, learned, workers, progress));
  }
  BakeSummary summary = write_baked(arguments, baked, workers, progress);
  if (arguments.refine != 0) ::unlink(written_path(kept).c_str());
  if (arguments.optimize.wanted()) {
    // The last one first: what is left where this is killed is found again.
    const std::vector<std::string> files = kept_files(learned);
    std::for_each(files.rbegin(), files.rend(),
                  [](const std::string& file) { ::unlink(written_path(file).c_str()); });
  }
  return summary;
}

BakeSummary bake_kept_tree(const BakeArguments& arguments, const NativeChoice& native,
                           const Progress& progress) {
  Workers workers;
  KeptTree kept = read_kept_tree(open_source(arguments.inputs.front()), progress);
  for (const std::string& text : notes_of(kept))
    note(fmt::format("{}: {}", shown_path(arguments.inputs.front()), text));
  set_native_scale(native, kept.scene);
  return write_baked(arguments, kept.scene, workers, progress);
}

}  // namespace voyager::tools
