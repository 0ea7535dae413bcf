// The options of `voyager bake`.
#include <unistd.h>

#include <algorithm>
#include <limits>

#include "runtime/format/writer.h"
#include "tools/commands/bake_arguments.h"
#include "tools/commands/commands.h"
#include "tools/options.h"

namespace voyager::tools {
namespace {

uint64_t half_of_memory() {
  return static_cast<uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
         static_cast<uint64_t>(::sysconf(_SC_PAGESIZE)) / 2;
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
                  "INRIA, a model of COLMAP (its folder), or a transforms.json of nerfstudio. "
                  "Pictures wider than 1600 pixels are assumed to have been trained at that width; "
                  "if they were trained at full size, give --native-pixel instead. "
                  "--optimize then learns up to half of its pictures from near them")
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
  arguments->memory = half_of_memory() / 1'000'000;
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
                   arguments->chunk_bytes,
                   "Bytes of records in a chunk, at most: 32 for each of its nodes")
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
