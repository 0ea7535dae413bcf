#include "runtime/scene/export/convert.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/open_source.h"
#include "runtime/format/reader.h"
#include "runtime/frame/scene.h"
#include "runtime/scene/import/importer.h"
#include "tools/commands/commands.h"
#include "tools/flat_output.h"
#include "tools/joined_inputs.h"
#include "tools/options.h"
#include "tools/output_paths.h"
#include "tools/placement.h"
#include "tools/progress_bar.h"

namespace voyager::tools {
namespace {

using Sources = std::vector<std::shared_ptr<const ByteSource>>;

struct ConvertArguments {
  std::vector<std::string> inputs;
  Placement placement;
  std::string output;
  FlatArguments flat;
};

void convert_flat(const Sources& sources, const ConvertArguments& arguments) {
  if (arguments.flat.keep && sources.size() == 1 && !arguments.placement.given() &&
      is_hier_name(sources.front()->name()))
    return export_kept_tree(sources.front(), arguments.flat, arguments.output);
  if (arguments.flat.keep)
    throw Error(ErrorCode::invalid_argument, "--keep: found " + sources.front()->name() +
                                                 ", which has no level-of-detail tree, expected a "
                                                 ".voy, or a .hier alone: bake it first");
  for (const auto& source : sources) note_left_out(*source);
  Workers workers;
  const FlatOptions options = flat_options(arguments.flat, arguments.output);
  describe_flat_file(arguments.output,
                     convert([&] { return open_joined(sources, arguments.placement); },
                             arguments.output, options, workers, progress_bar()),
                     options);
}

void convert_baked(const std::shared_ptr<const ByteSource>& source,
                   const ConvertArguments& arguments) {
  if (arguments.inputs.size() > 1)
    throw Error(ErrorCode::invalid_argument,
                "input: found " + source->name() +
                    " and other inputs, expected a .voy alone: convert it first");
  if (arguments.placement.given())
    throw Error(ErrorCode::invalid_argument,
                "--up, --transform: found " + source->name() +
                    ", expected inputs without a level-of-detail tree: convert it first");
  export_flat(SceneFile(source), arguments.flat, arguments.output);
}

void run(const ConvertArguments& arguments) {
  require_extension("-o", arguments.output, flat_format_endings());
  require_distinct({arguments.output}, arguments.inputs);
  arguments.placement.of(arguments.inputs.size());
  if (std::ranges::count(arguments.inputs, "-") > 0)
    throw Error(ErrorCode::invalid_argument,
                "input: found standard input, expected a file or a URL: it is read twice");
  Sources sources;
  for (const std::string& input : arguments.inputs) sources.push_back(open_source(input));
  const auto baked = std::ranges::find_if(
      sources, [](const auto& source) { return scene_format(*source) == SceneFormat::baked; });
  if (baked != sources.end())
    convert_baked(*baked, arguments);
  else
    convert_flat(sources, arguments);
}

}  // namespace

void add_convert(CLI::App& app) {
  auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* command = app.add_subcommand(
      "convert", "Write scenes in another format, without a level-of-detail tree");
  command
      ->add_option("input", arguments->inputs,
                   "Scenes to write as one, of any format that is read (docs/formats.md), or their "
                   "URLs; or one .voy, whose leaves are written, in the order of its input")
      ->required();
  command
      ->add_option("-o", arguments->output,
                   "File to write. The end of its name says which format: " +
                       CLI::detail::join(flat_format_endings(), ", "))
      ->type_name("FILE")
      ->required();
  name_group(*command, kCommonOptions);
  add_placement_options(*command, arguments->placement);
  add_flat_options(*command, arguments->flat);
  command->footer("Example: voyager convert scene.ply -o scene.spz");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace voyager::tools
