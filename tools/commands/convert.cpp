#include "runtime/scene/export/convert.h"

#include <memory>

#include "runtime/base/error.h"
#include "runtime/base/open_source.h"
#include "runtime/format/export_flat.h"
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
};

FlatContents convert_file(const ConvertArguments& arguments) {
  const std::shared_ptr<const ByteSource> source = open_source(arguments.input);
  if (scene_format(*source) == SceneFormat::baked)
    return export_leaves(SceneFile(source), arguments.output, progress_bar());
  Workers workers;
  return convert([&] { return open_blocks(source); }, arguments.output, workers, progress_bar());
}

void run(const ConvertArguments& arguments) {
  require_extension("-o", arguments.output, flat_format_endings());
  require_distinct({arguments.output}, {arguments.input});
  if (arguments.input == "-")
    throw Error(ErrorCode::invalid_argument,
                "input: found standard input, expected a file or a URL: it is read twice");
  describe_flat_file(arguments.output, convert_file(arguments));
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
  command->footer("Example: voyager convert scene.ply -o scene.spz");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace voyager::tools
