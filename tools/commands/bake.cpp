#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/bake/bake.h"
#include "runtime/base/clock.h"
#include "runtime/base/error.h"
#include "runtime/base/open_source.h"
#include "runtime/base/output_path.h"
#include "runtime/base/url.h"
#include "runtime/format/reader.h"
#include "runtime/format/writer.h"
#include "runtime/lod/build.h"
#include "runtime/lod/kept_tree.h"
#include "runtime/lod/validate.h"
#include "runtime/optimize/checkpoint.h"
#include "runtime/refine/measured.h"
#include "runtime/refine/refine.h"
#include "runtime/scene/append.h"
#include "runtime/scene/import/importer.h"
#include "tools/byte_size.h"
#include "tools/commands/commands.h"
#include "tools/commands/optimize_options.h"
#include "tools/console.h"
#include "tools/counted.h"
#include "tools/joined_inputs.h"
#include "tools/options.h"
#include "tools/output_paths.h"
#include "tools/placement.h"
#include "tools/progress_bar.h"
#include "tools/training_cameras.h"

namespace voyager::tools {
namespace {

uint64_t half_of_memory() {
  return static_cast<uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
         static_cast<uint64_t>(::sysconf(_SC_PAGESIZE)) / 2;
}

// K/N
struct Part {
  uint32_t part = 0, parts = 1;
};

struct BakeArguments {
  std::vector<std::string> inputs;
  Placement placement;
  std::string output;
  Quality quality = Quality::compact;
  uint32_t chunk_bytes = kDefaultChunkBytes;
  TreeKind tree = TreeKind::clustered;
  bool tree_given = false;
  uint32_t refine = 0;  // views
  OptimizeOptions optimize;
  double native_pixel = -1;  // metres; below 0: not given
  std::string training_cameras;
  bool verify = false;
  uint64_t memory = half_of_memory() / 1'000'000;  // MB
  std::string work;
  BakeStep step = BakeStep::all;
  std::optional<Part> part;
};

using Readers = std::vector<std::unique_ptr<BlockReader>>;

Readers open_all(const std::vector<std::string>& paths) {
  if (std::count(paths.begin(), paths.end(), "-") > 1)
    throw Error(ErrorCode::invalid_argument, "input: found - more than once, expected one stream");
  Readers readers;
  for (const std::string& path : paths) {
    if (path == "-") {
      readers.push_back(open_blocks(read_stdin()));
      continue;
    }
    const std::shared_ptr<const ByteSource> source = open_source(path);
    note_left_out(*source);
    readers.push_back(open_blocks(source));
  }
  return readers;
}

// Of all inputs together.
struct Announced {
  uint64_t gaussians = 0;
  int sh_degree = 0;
};

Announced announced_by(const Readers& readers) {
  Announced all;
  for (const auto& reader : readers) {
    all.gaussians += reader->count();
    all.sh_degree = std::max(all.sh_degree, reader->sh_degree());
  }
  return all;
}

uint64_t bytes_in_memory(const Announced& inputs, const BakeArguments& arguments) {
  return bytes_to_bake(inputs.gaussians, inputs.sh_degree) +
         (arguments.refine != 0 ? bytes_to_refine(inputs.gaussians) : 0) +
         (arguments.optimize.wanted() ? least_bytes_to_optimize(inputs.gaussians, inputs.sh_degree)
                                      : 0);
}

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

void print_summary(const BakeArguments& arguments, const BakeSummary& result,
                   const Stopwatch& watch) {
  say(fmt::format("{}: {}, {}, {}, {}, {}, {:.1f} s{}\n", arguments.output,
                  counted(result.gaussians, "Gaussian"), counted(result.nodes, "node"),
                  counted(result.subtrees, "subtree"), counted(result.chunks, "chunk"),
                  size_text(open_file_source(arguments.output)->size()),
                  watch.milliseconds() / 1000,
                  arguments.verify    ? ", verified"
                  : result.cells != 0 ? fmt::format(", in {} cells", result.cells)
                                      : ""));
  if (result.import.dropped() + result.import.repaired() > 0)
    say(fmt::format("{} dropped, {} repaired (voyager info {} tells which)\n",
                    counted(result.import.dropped(), "Gaussian"), result.import.repaired(),
                    arguments.output));
}

// What was measured for --refine so far.
std::string refine_file(const BakeArguments& arguments) {
  return arguments.output + ".refine";
}

// What was learned for --optimize so far.
std::string optimize_file(const BakeArguments& arguments) {
  return arguments.output + ".optimize";
}

// The pictures are taken to have been made as small as INRIA's trainer makes them by itself.
NativeChoice native_choice(const BakeArguments& arguments) {
  NativeChoice choice;
  if (arguments.native_pixel >= 0) choice.pixel = arguments.native_pixel;
  if (arguments.training_cameras.empty()) return choice;
  for (const TrainingCamera& camera : read_training_cameras(arguments.training_cameras))
    choice.cameras.push_back(downscaled(camera, usual_downscale(camera)));
  return choice;
}

void describe(const NativePixel& found) {
  note(fmt::format(
      "training cameras: they see {} of {} Gaussians, half of them with pixels below {:.4g} m, a "
      "tenth below {:.4g} m, a tenth above {:.4g} m: {}",
      found.seen, found.looked_at, found.median, found.tenth, found.ninetieth,
      found.scale().levels > 1 ? "each block of Gaussians gets its own" : "the scene gets one"));
}

// A file that was trained with a compensated filter is drawn with that, and with no footprint
// beside it: there is nothing to choose.
Readers open_inputs(const BakeArguments& arguments, const NativeChoice& native) {
  Readers readers = open_all(arguments.inputs);
  const bool chosen = native.pixel || !native.cameras.empty();
  for (const auto& reader : readers)
    if (chosen && reader->native().antialiased())
      throw Error(ErrorCode::refused_input,
                  reader->name() +
                      ": found a scene that was trained with a compensated filter, expected none "
                      "with --native-pixel and --training-cameras: it has no footprint");
  if (!arguments.placement.given()) return readers;
  return placed(std::move(readers), arguments.placement.of(readers.size()));
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
    print_learned(optimize_nodes(baked, goal, *backend, learned, workers, progress));
  }
  BakeSummary summary = write_baked(arguments, baked, workers, progress);
  if (arguments.refine != 0) ::unlink(written_path(kept).c_str());
  if (arguments.optimize.wanted())
    for (const std::string& file : kept_files(learned)) ::unlink(written_path(file).c_str());
  return summary;
}

// As of any cloud; what looks at Gaussians expects logits.
void set_native_scale(const NativeChoice& native, BakedScene& baked) {
  std::pmr::vector<float> linear = baked.leaves.opacity;
  for (float& opacity : baked.leaves.opacity) opacity = flat_logit(opacity);
  baked.leaves.native = baked.merged.native = native_scale(native, baked.leaves).scale;
  baked.leaves.opacity = std::move(linear);
}

// The tree of a .hier as it is.
BakeSummary bake_kept_tree(const BakeArguments& arguments, const NativeChoice& native,
                           const Progress& progress) {
  Workers workers;
  KeptTree kept = read_kept_tree(open_source(arguments.inputs.front()), progress);
  for (const std::string& text : notes_of(kept))
    note(fmt::format("{}: {}", shown_path(arguments.inputs.front()), text));
  set_native_scale(native, kept.scene);
  return write_baked(arguments, kept.scene, workers, progress);
}

BakeSummary bake_from_folder(const BakeArguments& arguments, const NativeChoice& native,
                             const OpenInputs& open, const Progress& progress) {
  if (arguments.verify)
    throw Error(ErrorCode::unsupported,
                "--verify: found a bake in a work folder, expected one in memory: the file is "
                "compared with the whole tree");
  if (arguments.tree != TreeKind::clustered)
    throw Error(
        ErrorCode::unsupported,
        "--tree hierarchicalgs: found a bake in a work folder, expected one in memory: give more "
        "--memory and no --work, or take the clustered tree");
  if (arguments.refine != 0)
    throw Error(ErrorCode::unsupported,
                "--refine: found a bake in a work folder, expected one in memory: give more "
                "--memory and no --work, or leave it out");
  if (arguments.optimize.wanted())
    throw Error(ErrorCode::unsupported,
                "--optimize: found a bake in a work folder, expected one in memory: give more "
                "--memory and no --work, or leave it out");
  BakeInParts bake;
  bake.request =
      bake_request(arguments.inputs, arguments.quality, arguments.chunk_bytes, {}, native) +
      request_lines(arguments.placement.of(arguments.inputs.size()));
  bake.native = native;
  bake.output = arguments.output;
  // One that nobody named goes when the bake fails, too; a kill leaves it.
  bake.temporary = arguments.work.empty();
  bake.work = bake.temporary ? arguments.output + ".work" : arguments.work;
  require_outside(bake.work, {arguments.output});
  require_outside(bake.work, arguments.inputs);
  require_not_below(arguments.output, bake.work);
  bake.quality = arguments.quality;
  bake.chunk_bytes = arguments.chunk_bytes;
  bake.memory = arguments.memory * 1'000'000;
  bake.step = arguments.step;
  const Part part = arguments.part.value_or(Part{});
  bake.part = part.part;
  bake.parts = part.parts;
  Workers workers;
  BakeSummary result = bake_in_parts(bake, open, workers, progress);
  if (result.by_cameras) describe(*result.by_cameras);
  for (const std::string& name : result.left)
    note(fmt::format("{}: not removed: {} is not a file of the bake", bake.work, name));
  return result;
}

// A .hier has a tree of its own, which stays unless another is asked for.
bool keeps_tree(const BakeArguments& arguments) {
  return arguments.inputs.size() == 1 && is_hier_name(shown_path(arguments.inputs.front())) &&
         !arguments.tree_given && !arguments.placement.given();
}

void require_kept_alone(const BakeArguments& arguments) {
  const auto refuse = [&](bool given, const char* option) {
    if (given)
      throw Error(ErrorCode::invalid_argument,
                  fmt::format("{}: found {}, whose own tree is kept, expected --tree clustered "
                              "beside it, which builds another",
                              option, shown_path(arguments.inputs.front())));
  };
  refuse(arguments.refine != 0, "--refine");
  refuse(arguments.optimize.wanted(), "--optimize");
  refuse(!arguments.training_cameras.empty(), "--training-cameras");
  refuse(!arguments.work.empty(), "--work");
}

bool writes_output(const BakeArguments& arguments) {
  return arguments.step == BakeStep::all || arguments.step == BakeStep::merge;
}

// The files that this command writes outside its work folder.
std::vector<std::string> outputs_of(const BakeArguments& arguments) {
  std::vector<std::string> outputs;
  if (writes_output(arguments)) outputs.push_back(arguments.output);
  if (arguments.refine != 0) outputs.push_back(refine_file(arguments));
  if (arguments.optimize.wanted()) outputs.push_back(optimize_file(arguments));
  return outputs;
}

void bake(const BakeArguments& arguments) {
  require_extension("-o", arguments.output, {".voy"});
  require_distinct(outputs_of(arguments), arguments.inputs);
  if (arguments.refine != 0 && arguments.tree != TreeKind::clustered)
    throw Error(ErrorCode::invalid_argument,
                "--refine: found --tree hierarchicalgs, expected the clustered tree: the other's "
                "extents are sides of boxes");
  if (arguments.optimize.wanted() && arguments.tree != TreeKind::clustered)
    throw Error(ErrorCode::invalid_argument,
                "--optimize: found --tree hierarchicalgs, expected the clustered tree");
  if (arguments.part && arguments.step != BakeStep::cells && arguments.step != BakeStep::encode)
    throw Error(ErrorCode::invalid_argument,
                "--part: found it without --step cells or encode, expected one of them");
  if (arguments.step != BakeStep::all && arguments.work.empty())
    throw Error(ErrorCode::invalid_argument, "--step: found no --work, expected its folder");
  arguments.placement.of(arguments.inputs.size());
  if (keeps_tree(arguments)) require_kept_alone(arguments);
  for (const std::string& output : outputs_of(arguments)) require_writable(output);
  if (arguments.refine != 0) check_kept(refine_file(arguments));
  if (arguments.optimize.wanted()) check_checkpoints(optimize_file(arguments));
  const NativeChoice native = native_choice(arguments);
  const Progress progress = progress_bar();
  const Stopwatch watch;
  if (!arguments.work.empty()) {
    const BakeSummary result = bake_from_folder(
        arguments, native, [&] { return open_inputs(arguments, native); }, progress);
    if (writes_output(arguments)) return print_summary(arguments, result, watch);
    say(fmt::format("{}: {} Gaussians in {} cells, {:.1f} s\n", arguments.work, result.gaussians,
                    result.cells, watch.milliseconds() / 1000));
    return;
  }
  Readers readers = open_inputs(arguments, native);
  const Announced inputs = announced_by(readers);
  require_room(arguments.output,
               bytes_of_scene(inputs.gaussians, inputs.sh_degree, arguments.quality));
  const uint64_t bytes = bytes_in_memory(inputs, arguments);
  if (bytes > arguments.memory * 1'000'000 && arguments.optimize.wanted())
    throw Error(ErrorCode::over_budget,
                fmt::format("--memory: found {} MB, expected at least {} with --optimize, which "
                            "bakes in memory",
                            arguments.memory, bytes / 1'000'000 + 1));
  if (keeps_tree(arguments)) {
    readers.clear();
    if (bytes > arguments.memory * 1'000'000)
      throw Error(ErrorCode::over_budget,
                  fmt::format("--memory: found {} MB, expected at least {} to keep the tree of {}; "
                              "--tree clustered builds another in less",
                              arguments.memory, bytes / 1'000'000 + 1,
                              shown_path(arguments.inputs.front())));
    return print_summary(arguments, bake_kept_tree(arguments, native, progress), watch);
  }
  if (bytes <= arguments.memory * 1'000'000)
    return print_summary(arguments, bake_in_memory(arguments, native, readers, progress), watch);
  print_summary(arguments,
                bake_from_folder(
                    arguments, native, [&] { return std::move(readers); }, progress),
                watch);
}

Part parse_part(const std::string& text) {
  const size_t slash = std::min(text.find('/'), text.size());
  const auto part = parse_whole(text.substr(0, slash));
  const auto parts = parse_whole(text.substr(std::min(slash + 1, text.size())));
  if (!part || !parts || *part >= *parts || *parts > std::numeric_limits<uint32_t>::max())
    throw CLI::ValidationError("--part", "found " + text + ", expected K/N with K from 0 to N - 1");
  return {static_cast<uint32_t>(*part), static_cast<uint32_t>(*parts)};
}

void add_native_options(CLI::App& command, BakeArguments& arguments) {
  CLI::Option* pixel =
      add_number_option(
          command, "--native-pixel", arguments.native_pixel,
          [](double metres) { return metres >= 0 && metres <= kMaxNativePixel; }, "0 to 1e6",
          "How large a pixel of the training pictures is where the scene is, in metres. 0 draws "
          "Gaussians as sharp as they are stored. Without this or cameras it is estimated")
          ->type_name("METRES")
          ->default_str("");
  command
      .add_option("--training-cameras", arguments.training_cameras,
                  "Find it from the cameras that the scene was trained with: a cameras.json of "
                  "INRIA, a model of COLMAP (its folder), or a transforms.json of nerfstudio")
      ->type_name("PATH")
      ->excludes(pixel);
  name_group(command, "What the scene was trained with");
}

void add_work_options(CLI::App& command, BakeArguments& arguments) {
  add_whole_option(command, "--memory", {16, uint64_t{1} << 40}, arguments.memory,
                   "About how many MB (10^6 bytes) of memory the bake may take. A scene that needs "
                   "more is baked in parts, from a work folder on disk. The default is half of "
                   "what this machine has")
      ->type_name("MB")
      ->default_str(std::to_string(arguments.memory));
  command
      .add_option("--work", arguments.work,
                  "Bake in parts, from this folder. A bake that was stopped goes on from there "
                  "when it is run again. The folder is removed at the end")
      ->type_name("DIR");
  add_choice<BakeStep>(command, "--step", arguments.step,
                       {{"all", BakeStep::all},
                        {"split", BakeStep::split},
                        {"cells", BakeStep::cells},
                        {"encode", BakeStep::encode},
                        {"merge", BakeStep::merge}},
                       "With --work: run one step of the bake and stop, for batch systems that "
                       "bake on several machines (docs/baking.md)");
  command
      .add_option_function<std::string>(
          "--part", [&arguments](const std::string& text) { arguments.part = parse_part(text); },
          "With --step cells or encode: do the K-th of N parts of that step, K from 0")
      ->type_name("K/N");
  name_group(command, "Scenes larger than memory");
}

}  // namespace

void add_bake(CLI::App& app) {
  auto arguments = std::make_shared<BakeArguments>();
  CLI::App* command =
      app.add_subcommand("bake", "Build the level-of-detail tree of a scene, and write a .voy");
  command
      ->add_option(
          "input", arguments->inputs,
          "Scenes to bake into one tree, of any format that is read (docs/formats.md), or their "
          "URLs. - is a .ply on standard input")
      ->required();
  command->add_option("-o", arguments->output, "File to write, a .voy")
      ->type_name("FILE")
      ->required();
  add_choice<Quality>(
      *command, "--quality", arguments->quality,
      {{"compact", Quality::compact}, {"lossless", Quality::lossless}},
      "compact is smaller, and rounds (docs/voy-format.md says how far). lossless keeps the exact "
      "values of the input");
  command->add_flag("--verify", arguments->verify,
                    "Check the whole tree, and read the file back. In memory only");
  name_group(*command, kCommonOptions);
  add_choice<TreeKind>(
      *command, "--tree", arguments->tree,
      {{"clustered", TreeKind::clustered}, {"hierarchicalgs", TreeKind::hierarchicalgs}},
      "How the tree is built. clustered joins what looks alike. hierarchicalgs builds as "
      "HierarchicalGS does, for comparison, in memory only. Without this the tree of a .hier that "
      "is the only input, and not moved, is kept as it is")
      ->each([arguments](const std::string&) { arguments->tree_given = true; });
  add_whole_option(*command, "--refine", {1, uint64_t{1} << 20}, arguments->refine,
                   "Also draw the scene from so many places, and measure where detail is seen "
                   "(docs/lod-tree.md). It takes about a second a place, and helps in some views: "
                   "400 places for a million Gaussians. A bake that was stopped goes on from "
                   "FILE.refine when it is run again. In memory only")
      ->type_name("VIEWS");
  add_whole_option(*command, "--chunk-bytes", {kMinChunkBytes, kMaxChunkBytes},
                   arguments->chunk_bytes, "Bytes of search records in a chunk, at most")
      ->default_str(std::to_string(arguments->chunk_bytes));
  name_group(*command, "The tree");
  add_optimize_options(*command, arguments->optimize);
  add_placement_options(*command, arguments->placement);
  add_native_options(*command, *arguments);
  add_work_options(*command, *arguments);
  command->footer("Example: voyager bake city.ply -o city.voy --quality lossless --verify");
  command->callback([arguments] { bake(*arguments); });
}

}  // namespace voyager::tools
