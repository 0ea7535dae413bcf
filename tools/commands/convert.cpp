#include "runtime/scene/export/convert.h"

#include <memory>

#include "runtime/base/error.h"
#include "runtime/base/open_source.h"
#include "runtime/format/reader.h"
#include "runtime/frame/scene.h"
#include "tools/commands/commands.h"
#include "tools/flat_output.h"
#include "tools/options.h"
#include "tools/output_paths.h"
#include "tools/progress_bar.h"

namespace voyager::tools {
namespace {

struct ConvertArguments {
  std::string input, output;
  FlatArguments flat;
};

void convert_flat(const std::shared_ptr<const ByteSource>& source,
                  const ConvertArguments& arguments) {
  if (arguments.flat.keep)
    throw Error(ErrorCode::invalid_argument,
                "--keep: found " + source->name() +
                    ", which has no level-of-detail tree, expected a .voy: bake it first");
  Workers workers;
  describe_flat_file(
      arguments.output,
      convert([&] { return open_blocks(source); }, arguments.output,
              flat_options(arguments.flat, arguments.output), workers, progress_bar()));
}

void run(const ConvertArguments& arguments) {
  require_extension("-o", arguments.output, flat_format_endings());
  require_distinct({arguments.output}, {arguments.input});
  if (arguments.input == "-")
    throw Error(ErrorCode::invalid_argument,
                "input: found standard input, expected a file or a URL: it is read twice");
  const std::shared_ptr<const ByteSource> source = open_source(arguments.input);
  if (scene_format(*source) == SceneFormat::baked)
    export_flat(SceneFile(source), arguments.flat, arguments.output);
  else
    convert_flat(source, arguments);
}

}  // namespace

void add_convert(CLI::App& app) {
  auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* command = app.add_subcommand(
      "convert", "Write a scene in another format, without a level-of-detail tree");
  command
      ->add_option("input", arguments->input,
                   "Scene to read, a .ply, a .spz or a .voy, or its URL. Of a .voy the leaves are "
                   "written, in the order of its input")
      ->required();
  command
      ->add_option("-o", arguments->output,
                   "File to write. The end of its name says which format: " +
                       CLI::detail::join(flat_format_endings(), ", "))
      ->type_name("FILE")
      ->required();
  name_group(*command, kCommonOptions);
  add_flat_options(*command, arguments->flat);
  command->footer("Example: voyager convert scene.ply -o scene.spz");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace voyager::tools
