#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "runtime/base/error.h"
#include "runtime/base/open_source.h"
#include "runtime/format/export_hier.h"
#include "runtime/format/export_ply.h"
#include "runtime/format/reader.h"
#include "tools/commands/commands.h"
#include "tools/cut_export.h"
#include "tools/options.h"
#include "tools/output_paths.h"
#include "tools/progress_bar.h"

namespace voyager::tools {
namespace {

struct Arguments {
  std::string scene, output, cameras;
  size_t camera = 0;
  ImageSize size;
  double tau = 3;
};

Camera choose_camera(const Arguments& arguments) {
  const auto cameras = read_cameras(arguments.cameras);
  if (arguments.camera >= cameras.size())
    throw Error(
        ErrorCode::invalid_argument,
        fmt::format("--camera: found {}, expected at most {} ({} has {} cameras)", arguments.camera,
                    cameras.size() - 1, arguments.cameras, cameras.size()));
  const Camera& camera = cameras[arguments.camera];
  return arguments.size.width == 0 ? camera
                                   : camera.resized(arguments.size.width, arguments.size.height);
}

void export_scene(const Arguments& arguments) {
  require_distinct({arguments.output}, {arguments.scene, arguments.cameras});
  if (!arguments.cameras.empty()) {
    require_extension("-o with --cut-camera", arguments.output, {".ply"});
    export_cut(arguments.scene, choose_camera(arguments), arguments.tau, arguments.output);
  } else {
    require_extension("-o", arguments.output, {".hier", ".ply"});
    const SceneFile scene(open_source(arguments.scene));
    const bool tree = std::filesystem::path(arguments.output).extension() == ".hier";
    (tree ? export_hier : export_ply)(scene, arguments.output, progress_bar());
  }
  fmt::print("{}\n", arguments.output);
}

}  // namespace

void add_export(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("export", "Write a .voy's tree or Gaussians for other tools");
  command->add_option("scene", arguments->scene, "A scene.voy")->required();
  command
      ->add_option("-o", arguments->output,
                   "out.hier: the tree, in HierarchicalGS's layout; out.ply: the leaves, in the "
                   "input's order")
      ->required();
  CLI::Option* cameras =
      command->add_option("--cut-camera", arguments->cameras,
                          "cameras.json: write one camera's interpolated cut to out.ply instead");
  command->add_option("--camera", arguments->camera, "Index of the camera in it")
      ->needs(cameras)
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  add_size_option(*command, arguments->size);
  add_tau_option(*command, arguments->tau);
  command->footer("Example: voyager export city.voy -o city.hier");
  command->callback([arguments] { export_scene(*arguments); });
}

}  // namespace voyager::tools
