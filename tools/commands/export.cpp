#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "runtime/base/error.h"
#include "runtime/base/name_ending.h"
#include "runtime/base/open_source.h"
#include "runtime/format/export_hier.h"
#include "runtime/format/export_tileset.h"
#include "runtime/format/reader.h"
#include "tools/byte_size.h"
#include "tools/commands/commands.h"
#include "tools/console.h"
#include "tools/counted.h"
#include "tools/cut_export.h"
#include "tools/flat_output.h"
#include "tools/options.h"
#include "tools/output_folder.h"
#include "tools/output_paths.h"
#include "tools/progress_bar.h"

namespace voyager::tools {
namespace {

struct ExportArguments {
  std::string scene, output, cameras;
  int64_t camera = 0;
  ImageSize size;
  double tau = 3;
  FlatArguments flat;
};

Camera choose_camera(const ExportArguments& arguments) {
  const Camera camera =
      camera_at(arguments.camera, 1, read_cameras(arguments.cameras), arguments.cameras).front();
  return arguments.size.width == 0 ? camera
                                   : camera.resized(arguments.size.width, arguments.size.height);
}

// A flat file of the scene's own tree can be asked for with --keep, and nothing else.
void refuse_keep(const FlatArguments& flat, const std::string& found, const std::string& expected) {
  if (flat.keep)
    throw Error(ErrorCode::invalid_argument, "--keep: found " + found + ", expected " + expected);
}

void refuse_keep_of_tree(const FlatArguments& flat, const std::string& output) {
  refuse_keep(flat, "-o " + output + ", which holds the whole tree",
              "a name that ends in one of " + CLI::detail::join(flat_format_endings(), ", "));
}

constexpr const char* kTileset = "tileset.json";

bool is_tileset(const std::string& output) {
  const std::string name = std::filesystem::path(output).filename().string();
  return has_ending(name, kTileset) && name.size() == std::string_view(kTileset).size();
}

std::string folder_of(const std::string& output) {
  const std::string folder = std::filesystem::path(output).parent_path().string();
  return folder.empty() ? "." : folder;
}

// The files of a tileset appear together, tileset.json last.
void export_tiles(const ExportArguments& arguments, const FlatOptions& options) {
  const std::string& output = arguments.output;
  refuse_keep_of_tree(arguments.flat, output);
  const SceneFile scene(open_source(arguments.scene));
  OutputFolder folder(folder_of(output), {arguments.scene});
  folder.require_place(kTileset);
  TilesetOptions tileset;
  tileset.flat = options;
  const TilesetSummary made = export_tileset(
      scene, [&](const std::string& name) { return folder.place(name); }, tileset, progress_bar());
  folder.commit();
  for (const std::string& lost : losses(FlatFormat::glb, made.contents, options))
    note(fmt::format("{}: {}", output, lost));
  const std::string leaves = made.leaves == 1 ? "1 leaf" : fmt::format("{} leaves", made.leaves);
  say(fmt::format("{}: {}, {} as {}, {}, the largest tile {}\n", output,
                  counted(made.tiles, "tile"), leaves, counted(made.gaussians, "Gaussian"),
                  size_text(made.bytes), size_text(made.largest)));
}

void export_scene(const ExportArguments& arguments) {
  const std::string& output = arguments.output;
  require_distinct({output}, {arguments.scene, arguments.cameras});
  const FlatOptions options = flat_options(arguments.flat, output, true);
  if (!arguments.cameras.empty()) {
    require_extension("-o with --cut-camera", output, flat_format_endings());
    refuse_keep(arguments.flat, "--cut-camera", "one of the two");
    const Camera camera = choose_camera(arguments);
    const Progress progress = progress_bar();
    progress("exporting", 0, 0);
    describe_flat_file(output, export_cut(arguments.scene, camera, arguments.tau, output, options),
                       options);
    return;
  }
  if (is_tileset(output)) return export_tiles(arguments, options);
  std::vector<std::string> endings = flat_format_endings();
  endings.insert(endings.begin(), {".hier", kTileset});
  require_extension("-o", output, endings);
  const SceneFile scene(open_source(arguments.scene));
  if (flat_format_of(output)) return export_flat(scene, arguments.flat, output);
  refuse_keep_of_tree(arguments.flat, output);
  export_hier(scene, output, progress_bar());
  const std::string lost = lost_native_pixel(scene.info().native);
  if (!lost.empty()) note(fmt::format("{}: {}", output, lost));
  say(fmt::format("{}: {}\n", output, size_text(std::filesystem::file_size(output))));
}

}  // namespace

void add_export(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command =
      app.add_subcommand("export", "Write the tree or the Gaussians of a .voy for other tools");
  command->add_option("scene", arguments->scene, "Scene to read, a .voy or its URL")->required();
  command
      ->add_option("-o", arguments->output,
                   "File to write. A .hier: the tree, in the layout of HierarchicalGS. "
                   "FOLDER/tileset.json: the tree as 3D Tiles, which clients stream. Else the "
                   "leaves, in the order of the input; the end of the name says in which format: " +
                       CLI::detail::join(flat_format_endings(), ", "))
      ->type_name("FILE")
      ->required();
  name_group(*command, kCommonOptions);
  add_flat_options(*command, arguments->flat);
  CLI::Option* cameras =
      command
          ->add_option("--cut-camera", arguments->cameras,
                       "A cameras.json: write what one of its cameras draws, interpolated, instead")
          ->type_name("FILE");
  add_camera_option(*command, arguments->camera)->needs(cameras);
  add_size_option(*command, arguments->size)->needs(cameras);
  add_tau_option(*command, arguments->tau)->needs(cameras);
  name_group(*command, "What one camera draws");
  command->footer("Example: voyager export city.voy -o city.hier");
  command->callback([arguments] { export_scene(*arguments); });
}

}  // namespace voyager::tools
