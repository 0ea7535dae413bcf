#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/open_source.h"
#include "runtime/base/url.h"
#include "runtime/format/reader.h"
#include "runtime/format/writer.h"
#include "runtime/lod/build.h"
#include "runtime/lod/validate.h"
#include "runtime/scene/append.h"
#include "runtime/scene/import/importer.h"
#include "tools/commands/commands.h"
#include "tools/options.h"
#include "tools/output_paths.h"
#include "tools/progress_bar.h"

namespace voyager::tools {
namespace {

struct Arguments {
  std::vector<std::string> inputs;
  std::string output;
  Quality quality = Quality::compact;
  uint32_t chunk_bytes = kDefaultChunkBytes;
  bool verify = false;
};

GaussianCloud read_one(const std::string& path, const Progress& progress) {
  ImportOptions options;
  options.progress = progress;
  if (path == "-") return import_gaussians(*read_stdin(), options);
  const auto source = open_source(path);
  return import_gaussians(*read_source(*source), options);
}

GaussianCloud read_all(const std::vector<std::string>& paths, const Progress& progress) {
  GaussianCloud cloud = read_one(paths.front(), progress);
  for (size_t i = 1; i < paths.size(); ++i)
    append(cloud, read_one(paths[i], progress), shown_path(paths[i]));
  return cloud;
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

void bake(const Arguments& arguments) {
  require_extension("-o", arguments.output, {".voy"});
  require_distinct({arguments.output}, arguments.inputs);
  const Progress progress = progress_bar();
  const Stopwatch watch;
  Workers workers;
  const BakedScene baked = build_tree(read_all(arguments.inputs, progress), workers, progress);
  if (arguments.verify) require_sound(arguments.output, validate(baked));
  const Partition partition = partition_tree(baked.tree, arguments.chunk_bytes);
  if (arguments.verify) require_sound(arguments.output, validate(partition, baked.tree));
  write_scene_file(baked, partition, arguments.output, arguments.quality, workers, progress);
  if (arguments.verify) verify_file(arguments.output, baked.tree, partition);
  fmt::print("{}: {} Gaussians, {} nodes, {} subtrees, {} chunks, {} bytes, {:.1f} s{}\n",
             arguments.output, baked.leaves.size(), baked.tree.size(), partition.subtrees.size(),
             partition.chunk_count(), open_file_source(arguments.output)->size(),
             watch.milliseconds() / 1000, arguments.verify ? ", verified" : "");
  if (const ImportReport& report = baked.leaves.report; report.dropped() + report.repaired() > 0)
    fmt::print("{} Gaussians dropped, {} repaired (voyager info {} tells which)\n",
               report.dropped(), report.repaired(), arguments.output);
}

}  // namespace

void add_bake(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("bake", "Build the level-of-detail tree of a scene and write a .voy");
  command
      ->add_option(
          "input", arguments->inputs,
          "One or several .ply or .spz, baked into one tree; - is a .ply on standard input")
      ->required();
  command->add_option("-o", arguments->output, "The scene.voy to write")->required();
  add_choice<Quality>(
      *command, "--quality", arguments->quality,
      {{"compact", Quality::compact}, {"lossless", Quality::lossless}},
      "compact quantises (errors in docs/voy-format.md); lossless keeps the input's own words");
  command
      ->add_option("--chunk-bytes", arguments->chunk_bytes,
                   "Bytes of search records a chunk, at most; the default is a warp's part of "
                   "sm_87's shared memory at full residency")
      ->check(CLI::Range(kMinChunkBytes, kMaxChunkBytes))
      ->capture_default_str();
  command->add_flag("--verify", arguments->verify,
                    "Check every invariant of the tree and its partition, and read the file back");
  command->footer("Example: voyager bake city.ply -o city.voy --quality lossless --verify");
  command->callback([arguments] { bake(*arguments); });
}

}  // namespace voyager::tools
